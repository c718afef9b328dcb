#include "mapper/mapper_config.h"

#include "core/error.h"

namespace waretwin {

MapperConfig MapperConfig::make(const std::string& profile) {
  MapperConfig config;
  config.profile = profile;
  if (profile == "paper") {
    config.rate_hz = 1.0;  // section 4.3: the paper's laptop kept up with one frame a second
    return config;
  }
  if (profile == "best") {
    config.localise.method = "local_map";
    config.objects = "evidence";
    config.label_margin_m = 0.015;
    config.integrate.method = "projection";
    config.integrate.mesh_min_weight = 0.02;  // one frame from 5 m, head on
    return config;
  }
  if (profile == "voxbloxpp") {
    config.rate_hz = 1.0;  // as profile paper, to be compared with it; the authors' own speed
    config.objects = "segments";
    // Their settings for SceneNN at 1 Hz.
    config.segments.merging_min_overlap_ratio = 0.15;
    config.segments.merging_min_frame_count = 3;
    // Ours, chosen on generated halls (docs/voxbloxpp.md): one wrong frame must not make a wall part of an object for good, and a box,
    // unlike a mask, also shows what stands behind and beside.
    config.segments.background_factor = 0.5;
    config.geometric.min_box_fill = 0.02;
    return config;
  }
  throw Error("profile '" + profile + "' is not known; expected paper, best or voxbloxpp");
}

void MapperConfig::visit(Fields& f) {
  const std::string before = profile;
  f("profile", profile, "the method whose constants the other keys start from", {.choices = {"paper", "best", "voxbloxpp"}});
  if (profile != before) {
    MapperConfig other = make(profile);
    other.poses = poses;
    other.detector = detector;
    other.model = model;
    other.boxes = boxes;
    *this = std::move(other);
  }
  f("rate_hz", rate_hz, "frames mapped a second, those in between are dropped; 0 = every frame", {.min = 0, .max = 1000});
  f("poses", poses, "where the vehicle's poses come from; auto: laser, else recorded, else odometry",
    {.choices = {"auto", "laser", "odometry", "recorded"}});
  f("detector", detector, "where the boxes come from: a network (model), files (boxes), or nowhere",
    {.choices = {"yolo", "boxes", "none"}});
  f("model", model,
    "detector: a folder, a .cfg, .weights or .onnx file, or the name of a shipped model; empty: the shipped model conveyor");
  f("boxes", boxes, "boxes by frame stamp: a JSON file, or a folder with a text file a frame");
  f("objects", objects, "how objects come about: accumulated points, as published, the evidence of all rays, or segments of the volume",
    {.choices = {"points", "evidence", "segments"}});
  f("label_margin_m", label_margin_m,
    "pixels this far outside their mapped object's cuboid get no label; below 0: all of a box's object get it", {.min = -1, .max = 10});
  f.group("localise", localise, "laser localisation");
  f.group("detect", detect, "the detector's network");
  f.group("segment", segment, "from boxes to object points and cuboids");
  f.group("rays", rays, "objects: evidence; what one frame tells");
  f.group("associate", associate, "objects: points; which mapped object a segmented one is");
  f.group("evidence", evidence, "objects: evidence; which mapped object a detection is, and its cuboid");
  f.group("geometric", geometric, "objects: segments; the depth picture cut into convex surfaces, and which of them a box holds");
  f.group("segments", segments, "objects: segments; which mapped segment is which, and which make up an object");
  f.group("integrate", integrate, "the labelled TSDF volume");
}

}  // namespace waretwin
