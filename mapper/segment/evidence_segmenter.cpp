#include "mapper/segment/evidence_segmenter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "mapper/associate/similarity.h"

namespace waretwin {
namespace {

constexpr double kSupportSamples = 8000;  // pixels looked at for the support of one object

bool inside(const cv::Rect2f& box, const Eigen::Vector2f& pixel) {
  return pixel.x() >= box.x && pixel.y() >= box.y && pixel.x() < box.x + box.width && pixel.y() < box.y + box.height;
}

cv::Rect2f grown(const cv::Rect2f& box, float by) { return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by}; }

cv::Rect2f grown(const cv::Rect2f& box, double share, double least_px) {
  const float dx = static_cast<float>(std::max(share * box.width, least_px)),
              dy = static_cast<float>(std::max(share * box.height, least_px));
  return {box.x - dx, box.y - dy, box.width + 2 * dx, box.height + 2 * dy};
}

// A surface is level where the neighbours on both axes of the picture lie at about the same height.
bool is_level(const DepthPoints& points, std::size_t i) {
  constexpr std::size_t kStep = 2;  // pixels
  constexpr float kSlope = 0.35f;   // 19 deg
  const auto width = static_cast<std::size_t>(points.width);
  const std::size_t u = i % width;
  if (points.depth[i] == 0.0f || u < kStep || u + kStep >= width || i < kStep * width || i + kStep * width >= points.depth.size())
    return false;
  for (const std::size_t step : {kStep, kStep * width}) {
    if (points.depth[i - step] == 0.0f || points.depth[i + step] == 0.0f) return false;
    const Eigen::Vector3f along = points.points_W[i + step] - points.points_W[i - step];
    if (std::abs(along.z()) > kSlope * along.head<2>().norm()) return false;
  }
  return true;
}

}  // namespace

EvidenceSegmenter::EvidenceSegmenter(const SegmentConfig& config, const EvidenceRaysConfig& rays, const StreamInfo& info)
    : config_(config), rays_config_(rays), cameras_(info.cameras), depth_rays_(info, rays.thin, rays.native) {}

bool EvidenceSegmenter::turns_too_fast(const RgbdFrame& frame, const Pose& X_WC) {
  const Eigen::Quaterniond q(X_WC.linear());
  const auto before = last_.find(frame.sensor);
  bool fast = false;
  if (before != last_.end() && frame.stamp > before->second.stamp) {
    const double seconds = to_seconds(frame.stamp - before->second.stamp);
    fast = q.angularDistance(before->second.q_WC) / seconds > to_radians(rays_config_.max_turn_deg_s);
  }
  last_[frame.sensor] = {frame.stamp, q};
  return fast;
}

Segmentation EvidenceSegmenter::segment(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<Detection>& detections,
                                        const Pose& X_WC) {
  Segmentation result;
  const bool fast = turns_too_fast(frame, X_WC);
  result.tells_nothing = fast;
  if (detections.empty()) return result;
  if (fast) {
    result.rejected["camera turns too fast"] += static_cast<int>(detections.size());
    return result;
  }
  double depth_min = config_.depth_min_m, depth_max = config_.depth_max_m;
  const auto camera = cameras_.find(frame.sensor);
  if (camera != cameras_.end()) {
    if (depth_min <= 0.0) depth_min = camera->second.depth_min_m;
    if (depth_max <= 0.0) depth_max = camera->second.depth_max_m;
  }
  if (depth_max <= 0.0) depth_max = std::numeric_limits<double>::infinity();

  const DepthPoints points = depth_rays_.points(frame, X_WC, depth_min, depth_max);
  const SupportPlane ground = ground_of(points);
  std::vector<Box> boxes;
  for (const Detection& detection : detections) {
    // Of boxes that are nearly the same one is enough.
    const auto same = [&](const Box& other) {
      return other.detection->class_name == detection.class_name && iou_2d(other.detection->box, detection.box) > rays_config_.same_box_iou;
    };
    if (std::any_of(boxes.begin(), boxes.end(), same)) {
      ++result.rejected["second box on an object"];
    } else {
      boxes.push_back(look_at(points, detection, ground));
    }
  }
  for (const Box& box : boxes) {
    SegmentedObject object;
    object.detection = *box.detection;
    if (box.on_support) object.support_W = box.floor;
    object.ground_W = ground.height;
    object.rays_from_W = points.from_W;
    const int with_depth = collect_rays(points, box, boxes, object.rays);
    if (with_depth * rays_config_.thin * rays_config_.thin < config_.min_pixels) {
      ++result.rejected["no depth"];
      continue;
    }
    collect_pixels(frame, intrinsics, X_WC, box, {depth_min, depth_max}, object);
    if (static_cast<int>(object.pixels.size()) < config_.min_pixels) {
      ++result.rejected["only ground or support"];
      continue;
    }
    result.objects.push_back(std::move(object));
  }
  return result;
}

EvidenceSegmenter::Box EvidenceSegmenter::look_at(const DepthPoints& points, const Detection& detection, const SupportPlane& ground) const {
  Box box;
  box.detection = &detection;
  const cv::Rect2f& b = detection.box;
  const auto support = support_of(points, b, ground.height);
  box.on_support = support.has_value();
  box.floor = support ? support->height : ground.height;
  const double sigma = support ? support->sigma : ground.sigma;
  box.clearance = static_cast<float>(std::clamp(3.0 * sigma, config_.planes.clearance_min_m, config_.planes.clearance_max_m));
  const auto slack =
      static_cast<float>(std::max<double>(rays_config_.box_slack_px, rays_config_.box_slack_share * std::max(b.width, b.height)));
  box.inner = grown(b, -slack);
  box.outer = grown(b, slack);
  box.region = grown(b, rays_config_.ring_share, rays_config_.ring_min_px);
  const auto& first = config_.cut_first;
  if (std::find(first.begin(), first.end(), detection.class_name) != first.end()) box.top = top_of(points, box);
  return box;
}

// The height at which most of what stands in the box is level: a table's top.
double EvidenceSegmenter::top_of(const DepthPoints& points, const Box& box) const {
  constexpr double kBin = 0.01, kLeast = 0.2;
  std::map<int, int> histogram;
  if (!std::isfinite(box.floor)) return std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < points.depth.size(); ++i) {
    if (points.depth[i] == 0.0f || !inside(box.inner, points.pixels[i])) continue;
    const double above = points.points_W[i].z() - box.floor;
    if (above > kLeast) ++histogram[static_cast<int>(above / kBin)];
  }
  if (histogram.empty()) return std::numeric_limits<double>::quiet_NaN();
  int best = 0, most = 0;
  for (const auto& [bin, count] : histogram) {
    if (count > most) best = bin, most = count;
  }
  return box.floor + (best + 0.5) * kBin;
}

// What a ray that ends inside the box and above its support is, where other boxes hold it as well.
RayKind EvidenceSegmenter::contested(const Box& mine, const std::vector<Box>& boxes, const Eigen::Vector2f& pixel, float z) const {
  constexpr double kTopThickness = 0.04, kTopNoise = 0.01;  // metres
  const auto at_top = [z](const Box& table) { return z >= table.top - kTopThickness && z <= table.top + kTopNoise; };
  RayKind kind = RayKind::object;
  for (const Box& other : boxes) {
    if (&other == &mine || !inside(other.outer, pixel)) continue;
    const bool my_table = std::isfinite(mine.top), other_table = std::isfinite(other.top);
    if (my_table != other_table) {
      // Section 4.2: tables first; what is left in their box belongs to what stands under or on them.
      if (my_table && !at_top(mine)) kind = RayKind::unknown;
      if (other_table && at_top(other)) kind = RayKind::unknown;
      continue;
    }
    const cv::Rect2f &a = mine.detection->box, &b = other.detection->box;
    const float shared = (a & b).area();
    // A box within another one is an object before or on the other.
    if (shared > 0.8f * a.area() && a.area() < 0.8f * b.area()) continue;
    kind = RayKind::unknown;
  }
  return kind;
}

int EvidenceSegmenter::collect_rays(const DepthPoints& points, const Box& box, const std::vector<Box>& boxes,
                                    std::vector<EvidenceRay>& rays) const {
  int with_depth = 0;
  for (std::size_t i = 0; i < points.depth.size(); ++i) {
    const Eigen::Vector2f& pixel = points.pixels[i];
    if (!inside(box.region, pixel)) continue;
    EvidenceRay ray{points.points_W[i], RayKind::other, is_level(points, i)};
    if (inside(box.outer, pixel)) {
      ++with_depth;
      const float above = ray.hit_W.z() - static_cast<float>(box.floor);
      if (above > box.clearance) {
        ray.kind = inside(box.inner, pixel) ? contested(box, boxes, pixel, ray.hit_W.z()) : RayKind::unknown;
      } else if (above > -box.clearance) {
        ray.kind = RayKind::unknown;
      }
    }
    rays.push_back(ray);
  }
  return with_depth;
}

// The same for the pixels of the colour view, which carry the labels.
void EvidenceSegmenter::collect_pixels(const RgbdFrame& frame, const Intrinsics& intrinsics, const Pose& X_WC, const Box& box,
                                       std::pair<double, double> depth_range, SegmentedObject& object) const {
  const cv::Rect2f& b = box.detection->box;
  const auto first = [](float edge) { return static_cast<int>(std::ceil(edge - 0.5f)); };
  const cv::Rect rect = cv::Rect(cv::Point(first(b.x), first(b.y)), cv::Point(first(b.x + b.width), first(b.y + b.height))) &
                        cv::Rect(0, 0, intrinsics.width, intrinsics.height);
  const Eigen::Matrix3f R_WC = X_WC.linear().cast<float>();
  const Eigen::Vector3f p_WC = X_WC.translation().cast<float>();
  const auto low = static_cast<float>(depth_range.first), high = static_cast<float>(std::min(depth_range.second, 1e6));
  const auto fx = static_cast<float>(1.0 / intrinsics.fx), fy = static_cast<float>(1.0 / intrinsics.fy);
  const auto cx = static_cast<float>(intrinsics.cx), cy = static_cast<float>(intrinsics.cy), floor = static_cast<float>(box.floor);
  for (int v = rect.y; v < rect.br().y; ++v) {
    const auto* row = frame.depth.ptr<float>(v);
    const float y = (static_cast<float>(v) - cy) * fy;
    for (int u = rect.x; u < rect.br().x; ++u) {
      const float z = row[u];
      if (!(z > low && z <= high)) continue;
      const Eigen::Vector3f p_W = R_WC * (z * Eigen::Vector3f((static_cast<float>(u) - cx) * fx, y, 1.0f)) + p_WC;
      if (p_W.z() - floor <= box.clearance) continue;
      object.pixels.push_back(v * intrinsics.width + u);
      object.points_W.push_back(p_W);
    }
  }
}

SupportPlane EvidenceSegmenter::ground_of(const DepthPoints& points) {
  const PlaneConfig& config = config_.planes;
  std::vector<HeightSample> samples;
  for (std::size_t i = 0; i < points.depth.size(); i += 7) {
    if (points.depth[i] != 0.0f) samples.push_back({0, 0, points.points_W[i].z(), false});
  }
  double rough = config.ground_height_m;
  if (config.ground != "world_zero") {
    // The lowest height at which much is level: a floor fills many pixels, what is seen through a hole in it does not.
    constexpr double kBin = 0.02, kShare = 0.05;
    std::map<int, int> histogram;
    for (const HeightSample& sample : samples) ++histogram[static_cast<int>(std::floor(sample.height / kBin))];
    const auto lowest = std::find_if(histogram.begin(), histogram.end(),
                                     [&](const auto& bin) { return bin.second > kShare * static_cast<double>(samples.size()); });
    // Out of sight, it is where it was last seen.
    if (lowest == histogram.end()) return last_ground_;
    rough = (lowest->first + 0.5) * kBin;
  }
  last_ground_ = refine_level(samples, rough, config.ground_tolerance_m, false);
  return last_ground_;
}

std::optional<SupportPlane> EvidenceSegmenter::support_of(const DepthPoints& points, const cv::Rect2f& box, double ground) const {
  const cv::Rect2f ring = grown(box, config_.planes.support_ring, 0.0);
  // Boxes of real detectors are a few pixels off: what lies at their very edge says nothing about inside and outside.
  const cv::Rect2f edge = grown(box, 0.03, 0.0);
  std::vector<HeightSample> samples;
  for (std::size_t i = 0; i < points.depth.size(); ++i) {
    if (points.depth[i] == 0.0f || !inside(ring, points.pixels[i])) continue;
    const bool in_box = inside(box, points.pixels[i]);
    if (!in_box && inside(edge, points.pixels[i])) continue;
    samples.push_back({points.pixels[i].x(), points.pixels[i].y(), points.points_W[i].z(), in_box});
  }
  const auto step = static_cast<std::size_t>(std::max(1.0, static_cast<double>(samples.size()) / kSupportSamples));
  if (step > 1) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < samples.size(); i += step) samples[kept++] = samples[i];
    samples.resize(kept);
  }
  return find_support(samples, {}, std::isfinite(ground) ? ground : config_.planes.ground_height_m, config_.planes);
}

}  // namespace waretwin
