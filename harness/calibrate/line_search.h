// Which line of each scan is the board, without knowing where the camera is: random sample consensus (Fischler and Bolles, 1981) over the
// poses, with the closed form as its model.
#pragma once

#include <optional>
#include <vector>

#include "core/pose.h"
#include "harness/calibrate/board_view.h"
#include "harness/calibrate/checker_board.h"
#include "harness/calibrate/scan_lines.h"

namespace waretwin {

struct BoardAndLines {
  BoardView board;              // its points are not looked at
  std::vector<ScanLine> lines;  // that may be it
};

// Lines of each pose that may be a board: no longer than its diagonal, and not in the scans of many other poses, too, as what belongs to
// the hall is while the vehicle stands.
std::vector<std::vector<ScanLine>> board_lines(const std::vector<StillPose>& still, const CheckerBoard& board);

struct LineSearch {
  Pose X_CL = Pose::Identity();
  std::vector<int> line;  // of each pose: which one is the board; -1: none
  int agreed = 0;         // poses with one
};

// Which line of each pose lies on its board, given the mounting.
LineSearch agreeing_lines(const std::vector<BoardAndLines>& poses, const CheckerBoard& board, const Pose& X_CL);

// The mounting on which most poses agree. Same input, same result. Nothing where fewer than six agree on any: five always do.
std::optional<LineSearch> search_lines(const std::vector<BoardAndLines>& poses, const CheckerBoard& board);

}  // namespace waretwin
