#include "mapper/stages.h"

#include <string>

#include "core/error.h"
#include "mapper/associate/evidence_associator.h"
#include "mapper/associate/paper_associator.h"
#include "mapper/associate/segment_associator.h"
#include "mapper/detect/boxes_detector.h"
#include "mapper/detect/shipped_models.h"
#include "mapper/detect/yolo_detector.h"
#include "mapper/integrate/grouped_ray_integrator.h"
#include "mapper/integrate/projective_integrator.h"
#include "mapper/localise/laser_icp_localiser.h"
#include "mapper/localise/local_map_localiser.h"
#include "mapper/localise/simple_localisers.h"
#include "mapper/segment/evidence_segmenter.h"
#include "mapper/segment/geometric_segmenter.h"
#include "mapper/segment/paper_segmenter.h"

namespace waretwin {

std::string chosen_poses(const MapperConfig& config, const StreamInfo& info) {
  if (config.poses != "auto") return config.poses;
  if (!info.lasers.empty()) return "laser";
  if (info.has_recorded_poses) return "recorded";
  return "odometry";
}

namespace {

std::unique_ptr<Localiser> make_localiser(const MapperConfig& config, const StreamInfo& info) {
  const std::string poses = chosen_poses(config, info);
  if (poses == "laser") {
    if (config.localise.method == "local_map") return std::make_unique<LocalMapLocaliser>(config.localise.local_map, info);
    return std::make_unique<LaserIcpLocaliser>(config.localise.icp, info);
  }
  if (poses == "recorded") {
    if (!info.has_recorded_poses) throw Error(info.source + ": poses 'recorded' were asked for, but the recording holds none");
    return std::make_unique<RecordedLocaliser>(info);
  }
  if (!info.has_odometry)
    throw Error(info.source + ": holds neither scans, nor poses, nor odometry; expected one of them for the vehicle's poses");
  return std::make_unique<OdometryLocaliser>(info);
}

}  // namespace

std::unique_ptr<Detector> make_detector(const MapperConfig& config) {
  if (config.detector == "yolo") {
    return std::make_unique<YoloDetector>(model_or_shipped(config.model), config.detect);
  }
  if (config.detector == "boxes") {
    if (config.boxes.empty())
      throw Error("mapper.boxes: no file; expected a JSON file with boxes by frame stamp, or a folder of text files");
    return std::make_unique<BoxesDetector>(config.boxes, config.detect);
  }
  return std::make_unique<NoDetector>();
}

std::unique_ptr<Associator> make_associator(const MapperConfig& config) {
  if (config.objects == "evidence") return std::make_unique<EvidenceAssociator>(config.evidence);
  if (config.objects == "segments") return std::make_unique<SegmentAssociator>(config.segments);
  return std::make_unique<PaperAssociator>(config.associate);
}

std::unique_ptr<Integrator> make_integrator(const TsdfConfig& config) {
  if (config.method == "projection") return std::make_unique<ProjectiveIntegrator>(config);
  return std::make_unique<GroupedRayIntegrator>(config);
}

Stages make_stages(const MapperConfig& config, const StreamInfo& info) {
  Stages stages;
  stages.localiser = make_localiser(config, info);
  stages.detector = make_detector(config);
  if (config.objects == "evidence") {
    stages.segmenter = std::make_unique<EvidenceSegmenter>(config.segment, config.rays, info);
  } else if (config.objects == "segments") {
    stages.segmenter = std::make_unique<GeometricSegmenter>(config.segment, config.geometric, info);
  } else {
    stages.segmenter = std::make_unique<PaperSegmenter>(config.segment, info);
  }
  stages.associator = make_associator(config);
  stages.integrator = make_integrator(config.integrate);
  return stages;
}

}  // namespace waretwin
