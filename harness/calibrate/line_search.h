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

// Lines of a scan that may be the board. The first `moved` of them are in few other scans, as that of a board is; the others stand in many
// poses, as what belongs to the hall does while the vehicle stands.
struct BoardLines {
  std::vector<ScanLine> lines;
  std::size_t moved = 0;
};

// Of each pose those that are as long as a line on the board can be.
std::vector<BoardLines> board_lines(const std::vector<StillPose>& still, const CheckerBoard& board);

struct BoardAndLines {
  BoardView board;  // its points are not looked at
  BoardLines candidates;
};

struct LineSearch {
  Pose X_CL = Pose::Identity();
  std::vector<int> line;  // of each pose: which one is the board; -1: none
  int agreed = 0;         // poses with one
};

// Which line of each pose lies on its board, given the mounting.
LineSearch agreeing_lines(const std::vector<BoardAndLines>& poses, const CheckerBoard& board, const Pose& X_CL);

// The mounting on which most poses agree, from samples of lines that moved (of all lines of a pose where none did). Same input, same
// result. Nothing where fewer than six agree on any.
std::optional<LineSearch> search_lines(const std::vector<BoardAndLines>& poses, const CheckerBoard& board);

}  // namespace waretwin
