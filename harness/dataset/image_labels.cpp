#include "harness/dataset/image_labels.h"

#include <algorithm>

#include "core/error.h"
#include "harness/truth/mask_outlines.h"
#include "mapper/detect/mask_runs.h"

namespace waretwin {

ImageLabels label_objects(const std::vector<ObjectView>& views, const cv::Mat& instances, const Scene& scene,
                          const std::vector<std::string>& classes, const LabelRule& rule, double polygon_tolerance_px) {
  ImageLabels result;
  for (const ObjectView& view : views) {
    if (view.visible_px == 0) continue;
    const auto object = std::find_if(scene.objects.begin(), scene.objects.end(), [&](const TrueObject& o) { return o.id == view.id; });
    WARETWIN_CHECK(object != scene.objects.end(), "a view is of an object of the scene");
    const auto named = std::find(classes.begin(), classes.end(), object->class_name);
    if (named == classes.end()) continue;
    const auto class_index = static_cast<int>(named - classes.begin());
    if (!rule.labels(view)) {
      result.left_out.push_back(
          {view.id, class_index, view.visible_box, rule.too_small(view) ? LeftOut::Why::kSmall : LeftOut::Why::kHidden});
      continue;
    }
    ImageLabel label;
    label.object_id = view.id;
    label.class_index = class_index;
    label.box = view.visible_box;
    label.area_px = view.visible_px;
    label.visible = view.visible();
    label.occluded = view.occluded();
    label.truncated = view.truncated();
    label.amodal_box = view.amodal_box;
    label.crosses_camera_plane = view.crosses_camera_plane;
    label.leaves_margin = view.leaves_margin;
    const cv::Mat mask = instances(view.visible_box) == view.id;
    label.polygons = outlines(mask, view.visible_box.tl(), polygon_tolerance_px);
    label.runs = compressed_runs(run_lengths(mask, view.visible_box, instances.size()));
    result.labels.push_back(std::move(label));
  }
  return result;
}

}  // namespace waretwin
