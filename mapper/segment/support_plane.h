// Which horizontal plane a detected object stands on.
#pragma once

#include <optional>
#include <vector>

#include "mapper/segment/segment_config.h"

namespace waretwin {

// Pixels with trusted depth in and around a 2D box, with their height above the ground.
struct HeightSample {
  float u = 0, v = 0;   // pixels
  float height = 0;     // metres above the ground's zero
  bool in_box = false;  // in the detection's own box, else in the ring around it
};

struct SupportPlane {
  double height = 0.0;  // metres
  double sigma = 0.0;   // metres: spread of the plane's own points
};

// A robust fit of one level: mean and spread of the heights near `height`.
SupportPlane refine_level(const std::vector<HeightSample>& samples, double height, double reach, bool ring_only);

// The supporting plane, or nothing for an object that stands on the ground. Candidates are heights of horizontal planes (`levels`, from
// the frame's multi-plane segmentation) and peaks in the heights of the ring, which find a strip too narrow to be segmented: a level
// surface piles its points up at one height, a wall spreads them. A support
//   - goes on beyond the object: it fills a share of the ring around the box (its own top, a belt or a seat, ends with the box);
//   - carries the object: what lies above it within the box spans most of what has depth there (parcels on a belt do not, nor does a
//   chair's back).
// Of several the highest is taken: a table's top carries what stands on it, its lower shelf does not, however much of it is seen.
std::optional<SupportPlane> find_support(const std::vector<HeightSample>& samples, const std::vector<double>& levels, double ground_height,
                                         const PlaneConfig& config);

}  // namespace waretwin
