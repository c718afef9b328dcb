// The page of a run's folder: what `waretwin run` and `waretwin map` leave.
#pragma once

#include <filesystem>
#include <string>

#include "harness/report/page_data.h"

namespace waretwin {

// Reads the folder; whatever part is missing (truth, frames, mesh, timing) is missing on the page. `score` is the text of score.json, for a
// run whose score.json is yet to be written; empty: the folder's, if it has one. Everything is in the map's upright world (upright.json).
//
// json beside the keys of PageData, each null where there is none:
//   score (score.json), map (map.json), paper {table6, table4}, budget, verdict (budget.md, baseline.md as they are)
//   mapped, truth: [{id, class, centre, yaw, size, score}]
//   path, true_path: [[t_s, x, y, z, yaw]], at most 1500 poses, at the same stamps; t_s from the first pose
//   path_error: [[t_s, metres, degrees]] between the two, as they are
//   timing: {stages: [{stage, mean, median, p95, max}], frames: [[t_s, localise, detect, segment, associate, integrate]]} in ms
//   frames: [{frame, t_s, sensor, size, intrinsics, X_WC, X_WB, detections, objects, colour, depth}] (frame_log.h); colour, depth: blocks
//   mesh: {vertices, triangles, of_triangles, low, step, label_ids, floor, seen, error_step}; blocks mesh.positions, .colours, .labels,
//   .indices, .errors, .seen (the number of the frame that saw the vertex first) pictures: [{caption, block}]
PageData run_page(const std::filesystem::path& folder, const std::string& score = {});

}  // namespace waretwin
