// Every constant of the mapper, in one tree. Profile `paper` is the published method, constants included; `best` is ours;
// `voxbloxpp` is the method that the paper compares itself with.
#pragma once

#include <string>

#include "core/fields.h"
#include "mapper/associate/associate_config.h"
#include "mapper/associate/evidence_config.h"
#include "mapper/associate/segments_config.h"
#include "mapper/detect/detect_config.h"
#include "mapper/integrate/tsdf_config.h"
#include "mapper/localise/localise_config.h"
#include "mapper/segment/evidence_rays_config.h"
#include "mapper/segment/geometric_config.h"
#include "mapper/segment/segment_config.h"

namespace waretwin {

struct MapperConfig {
  std::string profile = "best";
  double rate_hz = 0.0;            // frames mapped a second, those in between are dropped; 0 = every frame
  std::string poses = "auto";      // where X_WB comes from; auto: laser where the stream has scans, else recorded, else odometry
  std::string detector = "none";   // yolo: the network in `model`; boxes: the file in `boxes`; none: no objects
  std::string model;               // folder, .cfg, .weights or .onnx file, or a shipped model's name; empty: see model_or_shipped()
  std::string boxes;               // JSON file with boxes by frame stamp
  std::string objects = "points";  // how objects come about: "points" as published, "evidence" of all rays, "segments" of the volume
  double label_margin_m = -1.0;    // pixels farther outside their object's cuboid get no label; below 0: all get it
  LocaliseConfig localise;
  DetectConfig detect;
  SegmentConfig segment;
  EvidenceRaysConfig rays;
  AssociateConfig associate;
  EvidenceConfig evidence;
  GeometricConfig geometric;
  SegmentsConfig segments;
  TsdfConfig integrate;

  // The constants of a profile: paper, best or voxbloxpp. Throws Error naming the known ones.
  static MapperConfig make(const std::string& profile);
  // A `profile` that changes sets all other fields before those that follow it, but for where poses and boxes come from.
  void visit(Fields& f);
};

}  // namespace waretwin
