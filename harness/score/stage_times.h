// How long the stages of a run took, from the timing.csv that it left.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace waretwin {

// Milliseconds a mapped frame, averaged over frames.
struct StageTimes {
  int frames = 0;
  double localise = 0.0, detect = 0.0, segment = 0.0, associate = 0.0, integrate = 0.0;
  // The stages of the paper's Table 4; it takes poses as given.
  double total() const { return detect + segment + associate + integrate; }
};

// Columns are found by their names in the first line (localise_ms, detect_ms, ..). Nothing where no frame was mapped. Throws Error with
// file and line for a missing column, a row of another length, or what is no time.
std::optional<StageTimes> read_stage_times(const std::filesystem::path& timing_csv);

// Averaged over sequences, each counting the same; frames are added up. Nothing of nothing.
std::optional<StageTimes> mean_times(const std::vector<StageTimes>& sequences);

}  // namespace waretwin
