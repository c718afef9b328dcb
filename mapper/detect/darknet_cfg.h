// What a Darknet network description says about itself, read before anything is loaded, so that a wrong or truncated weights file is
// noticed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace waretwin {

struct DarknetSummary {
  int width = 0, height = 0;               // network input in pixels
  int classes = 0;                         // of the last [yolo] or [region] section
  std::optional<std::int64_t> parameters;  // numbers in the weights file; nothing where a section's need is not known
};

// Throws Error with file and line for text that is no Darknet cfg, lacks [net] or has no [yolo] or [region] section.
DarknetSummary read_darknet_cfg(const std::filesystem::path& cfg);

// Throws Error where the weights file's size is not what the network needs (its header is 16 or 20 bytes, by its version).
void check_darknet_weights(const std::filesystem::path& weights, const DarknetSummary& summary);

// The description as text with thresh=0 in every head: without it OpenCV sets scores up to 0.2 to 0, and which ones count is said by the
// caller, not by the model.
std::string darknet_cfg_with_all_scores(const std::filesystem::path& cfg);

}  // namespace waretwin
