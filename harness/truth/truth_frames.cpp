#include "harness/truth/truth_frames.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "harness/pictures/rasteriser.h"
#include "mapper/detect/mask_runs.h"

namespace waretwin {

namespace {

using Json = nlohmann::ordered_json;

// Four decimals: a pixel of ten thousand.
double rounded(double share) { return std::round(share * 1e4) / 1e4; }

Json box_json(const cv::Rect& box) {
  if (box.empty()) return nullptr;
  return {box.x, box.y, box.width, box.height};
}

Json pose_json(const Pose& X) {
  Eigen::Quaterniond q(X.rotation());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d& p = X.translation();
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

const TrueObject& object_of(const Scene& scene, int id) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(), [id](const TrueObject& object) { return object.id == id; });
  WARETWIN_CHECK(found != scene.objects.end(), "a view is of an object of the scene");
  return *found;
}

void draw_dashed(cv::Mat& image, const cv::Rect& box, const cv::Scalar& colour) {
  constexpr int kDash = 10, kGap = 7;
  const cv::Rect inside = box & cv::Rect(cv::Point(), image.size());
  if (inside.empty()) return;
  const int left = box.x, top = box.y, right = box.x + box.width - 1, bottom = box.y + box.height - 1;
  for (int u = inside.x; u < inside.x + inside.width; u += kDash + kGap) {
    const int end = std::min(u + kDash, inside.x + inside.width - 1);
    for (const int v : {top, bottom}) cv::line(image, {u, v}, {end, v}, colour, 2);
  }
  for (int v = inside.y; v < inside.y + inside.height; v += kDash + kGap) {
    const int end = std::min(v + kDash, inside.y + inside.height - 1);
    for (const int u : {left, right}) cv::line(image, {u, v}, {u, end}, colour, 2);
  }
}

}  // namespace

void TruthFramesConfig::visit(Fields& f) {
  f("enabled", enabled, "truth_frames.jsonl and pictures of it: what each mapped frame shows of every true object");
  f("masks", masks, "with amodal masks");
}

std::string truth_frame_line(const FrameTruth& truth, const std::vector<ObjectView>& views, const Scene& scene, bool masks) {
  const cv::Size size = truth.instances.size();
  Json line;
  line["stamp_ns"] = truth.stamp;
  line["sensor"] = truth.sensor;
  line["size"] = {size.width, size.height};
  line["X_WC"] = pose_json(truth.X_WC);
  line["objects"] = Json::array();
  for (const ObjectView& view : views) {
    Json object;
    object["id"] = view.id;
    object["class"] = object_of(scene, view.id).class_name;
    object["visible"] = rounded(view.visible());
    object["occluded"] = rounded(view.occluded());
    object["truncated"] = rounded(view.truncated());
    object["visible_px"] = view.visible_px;
    object["amodal_px"] = view.amodal_px;
    object["amodal_px_total"] = view.amodal_px_total;
    object["visible_box"] = box_json(view.visible_box);
    object["amodal_box"] = box_json(view.amodal_box);
    object["beyond_step_px"] = view.beyond_step;
    object["crosses_camera_plane"] = view.crosses_camera_plane;
    object["leaves_margin"] = view.leaves_margin;
    if (masks) {
      if (view.amodal_px > 0) {
        object["amodal_mask"] = {{"size", {size.height, size.width}}, {"counts", run_lengths(view.amodal_mask, view.mask_box, size)}};
      } else {
        object["amodal_mask"] = nullptr;
      }
    }
    line["objects"].push_back(object);
  }
  return line.dump() + "\n";
}

cv::Mat draw_truth(const cv::Mat& colour, const FrameTruth& truth, const std::vector<ObjectView>& views, const Scene& scene) {
  cv::Mat tinted = 0.45 * colour;
  for (const ObjectView& view : views) {
    const cv::Scalar tint = colour_of_id(view.id);
    if (view.amodal_px == 0) continue;
    cv::Mat part = tinted(view.mask_box);
    const cv::Mat flat(part.size(), part.type(), tint);
    cv::Mat faint, full;
    cv::addWeighted(part, 0.8, flat, 0.2, 0.0, faint);  // hidden parts, too
    faint.copyTo(part, view.amodal_mask);
    cv::addWeighted(colour(view.mask_box), 0.4, flat, 0.6, 0.0, full);
    full.copyTo(part, truth.instances(view.mask_box) == view.id);
  }
  // Two thirds as large in the middle, so that a quarter of the width and height beyond each border has a place.
  const auto across = [](int u, int length) { return static_cast<int>(std::lround((u + 0.25 * length) * 2.0 / 3.0)); };
  const auto placed = [&](const cv::Rect& box) {
    const cv::Point low(across(box.x, colour.cols), across(box.y, colour.rows));
    return cv::Rect(low, cv::Point(across(box.br().x, colour.cols), across(box.br().y, colour.rows)));
  };
  cv::Mat image(colour.size(), CV_8UC3, cv::Scalar::all(24));
  const cv::Rect middle = placed(cv::Rect({}, colour.size()));
  cv::resize(tinted, image(middle), middle.size(), 0, 0, cv::INTER_AREA);
  for (const ObjectView& view : views) {
    draw_dashed(image, placed(view.amodal_box), colour_of_id(view.id));
    if (!view.visible_box.empty()) cv::rectangle(image, placed(view.visible_box), colour_of_id(view.id), 2);
  }
  for (const ObjectView& view : views) {
    const cv::Rect at = placed(view.amodal_box) & cv::Rect({}, image.size());
    if (at.empty()) continue;
    const TrueObject& object = object_of(scene, view.id);
    char text[128];
    if (view.amodal_px == 0) {
      std::snprintf(text, sizeof text, "%d", view.id);  // there may be many of them, far away
    } else {
      std::snprintf(text, sizeof text, "%.40s %d: visible %.0f %%, occluded %.0f %%, truncated %.0f %%", object.class_name.c_str(), view.id,
                    100.0 * view.visible(), 100.0 * view.occluded(), 100.0 * view.truncated());
    }
    const int width = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 0.5, 1, nullptr).width;
    draw_text(image, {std::clamp(at.x, 4, std::max(4, image.cols - width - 4)), std::clamp(at.y - 6, 14, image.rows - 6)}, text,
              cv::Scalar::all(255));
  }
  return image;
}

}  // namespace waretwin
