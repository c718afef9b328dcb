#include "harness/train/region_loss.h"

#include <algorithm>
#include <cmath>

#include "harness/train/region_boxes.h"

namespace waretwin::train {
namespace {

struct Positive {
  const TruthBox* box = nullptr;
  double shape_agreement = 0.0;
};

// For each cell and anchor of a batch the object that it learns, if any.
std::vector<Positive> assign(const std::vector<std::vector<TruthBox>>& truth, const NetworkPlan& plan, double anchor_iou) {
  const int rows = plan.rows(), columns = plan.columns(), anchors = static_cast<int>(plan.anchors.size());
  std::vector<Positive> positives(truth.size() * anchors * rows * columns);
  for (std::size_t n = 0; n < truth.size(); ++n) {
    for (const TruthBox& box : truth[n]) {
      if (box.ignored) continue;
      const BoxShape shape{box.share.width * columns, box.share.height * rows};
      const int column = std::clamp(static_cast<int>((box.share.x + 0.5f * box.share.width) * columns), 0, columns - 1);
      const int row = std::clamp(static_cast<int>((box.share.y + 0.5f * box.share.height) * rows), 0, rows - 1);
      double best = 0.0;
      for (const BoxShape& anchor : plan.anchors) best = std::max(best, shape_iou(shape, anchor));
      for (int a = 0; a < anchors; ++a) {
        const double agreement = shape_iou(shape, plan.anchors[a]);
        if (agreement < best && agreement < anchor_iou) continue;
        Positive& positive = positives[((n * anchors + a) * rows + row) * columns + column];
        if (positive.box == nullptr || agreement > positive.shape_agreement) positive = {&box, agreement};
      }
    }
  }
  return positives;
}

// `box_anywhere` may reach beyond the picture, where a detector cuts it off.
bool is_no_mistake(const cv::Rect2f& box_anywhere, const std::vector<TruthBox>& truth, double ignore_iou) {
  const cv::Rect2f predicted = box_anywhere & cv::Rect2f(0, 0, 1, 1);
  for (const TruthBox& box : truth) {
    if (box.ignored ? (predicted & box.share).area() > 0.5f * predicted.area() : box_iou(predicted, box.share) > ignore_iou) return true;
  }
  return false;
}

// 1 - complete IoU of boxes as centre and size, (P, 4) each, and the plain IoU without gradients.
at::Tensor complete_iou_loss(const at::Tensor& a, const at::Tensor& b, at::Tensor& iou_out) {
  const auto column = [](const at::Tensor& t, int i) { return t.select(1, i); };
  const at::Tensor ax = column(a, 0), ay = column(a, 1), aw = column(a, 2), ah = column(a, 3);
  const at::Tensor bx = column(b, 0), by = column(b, 1), bw = column(b, 2), bh = column(b, 3);
  const at::Tensor left = at::max(ax - aw / 2, bx - bw / 2), right = at::min(ax + aw / 2, bx + bw / 2);
  const at::Tensor top = at::max(ay - ah / 2, by - bh / 2), bottom = at::min(ay + ah / 2, by + bh / 2);
  const at::Tensor common = (right - left).clamp_min(0) * (bottom - top).clamp_min(0);
  const at::Tensor iou = common / (aw * ah + bw * bh - common + 1e-9);
  const at::Tensor hull_w = at::max(ax + aw / 2, bx + bw / 2) - at::min(ax - aw / 2, bx - bw / 2);
  const at::Tensor hull_h = at::max(ay + ah / 2, by + bh / 2) - at::min(ay - ah / 2, by - bh / 2);
  const at::Tensor distance = ((ax - bx).square() + (ay - by).square()) / (hull_w.square() + hull_h.square() + 1e-9);
  const at::Tensor turn = at::atan(bw / bh) - at::atan(aw / (ah + 1e-9));
  const at::Tensor aspect = turn.square() * (4.0 / (M_PI * M_PI));
  const at::Tensor weight = (aspect / (1.0 - iou + aspect + 1e-9)).detach();
  iou_out = iou.detach();
  return 1.0 - iou + distance + weight * aspect;
}

}  // namespace

RegionLoss region_loss(const at::Tensor& output, const std::vector<std::vector<TruthBox>>& truth, const NetworkPlan& plan,
                       const TrainConfig& config) {
  const auto count = static_cast<std::int64_t>(truth.size());
  const std::int64_t anchors = static_cast<std::int64_t>(plan.anchors.size()), rows = plan.rows(), columns = plan.columns();
  const std::int64_t numbers = plan.numbers();
  // A line each cell and anchor, in the order of `assign`.
  const at::Tensor lines =
      output.contiguous().view({count, anchors, numbers, rows, columns}).permute({0, 1, 3, 4, 2}).reshape({-1, numbers});
  const std::vector<Positive> positives = assign(truth, plan, config.anchor_iou);

  const at::Tensor plain = lines.detach().contiguous();
  const float* const values = plain.data_ptr<float>();
  at::Tensor object_target = at::zeros({lines.size(0)}), object_weight = at::ones({lines.size(0)});
  std::vector<std::int64_t> where;
  std::vector<float> cell, goal;
  std::vector<std::int64_t> goal_class;
  for (std::int64_t i = 0; i < lines.size(0); ++i) {
    const std::int64_t column = i % columns, row = i / columns % rows, a = i / (columns * rows) % anchors,
                       n = i / (columns * rows * anchors);
    if (const TruthBox* const box = positives[i].box) {
      where.push_back(i);
      cell.insert(cell.end(), {static_cast<float>(column), static_cast<float>(row), static_cast<float>(plan.anchors[a].width),
                               static_cast<float>(plan.anchors[a].height)});
      goal.insert(goal.end(), {(box->share.x + 0.5f * box->share.width) * columns, (box->share.y + 0.5f * box->share.height) * rows,
                               box->share.width * columns, box->share.height * rows});
      goal_class.push_back(box->class_index);
    } else if (!truth[n].empty() && is_no_mistake(region_box(values + i * numbers, plan, a, row, column), truth[n], config.ignore_iou)) {
      object_weight.data_ptr<float>()[i] = 0.0f;
    }
  }

  RegionLoss loss;
  const auto found = static_cast<std::int64_t>(where.size());
  // A batch with few objects does not shout.
  const double share = 1.0 / static_cast<double>(std::max(found, count));
  loss.total = at::zeros({});
  if (found > 0) {
    const at::Tensor index = at::tensor(where);
    const at::Tensor cells = at::tensor(cell).view({found, 4}), goals = at::tensor(goal).view({found, 4});
    const at::Tensor mine = lines.index_select(0, index);
    const at::Tensor boxes = at::cat({at::sigmoid(mine.narrow(1, 0, 2)) + cells.narrow(1, 0, 2),
                                      at::exp(mine.narrow(1, 2, 2).clamp_max(kLargestExponent)) * cells.narrow(1, 2, 2)},
                                     1);
    at::Tensor iou;
    const at::Tensor box = complete_iou_loss(boxes, goals, iou).sum() * share;
    object_target.index_put_({index}, iou.clamp(0, 1));
    loss.box = box.item<double>();
    loss.total = loss.total + config.box_weight * box;
    if (plan.classes > 1) {
      const at::Tensor classes =
          at::cross_entropy_loss(mine.narrow(1, 5, plan.classes), at::tensor(goal_class), {}, at::Reduction::Sum) * share;
      loss.classes = classes.item<double>();
      loss.total = loss.total + config.class_weight * classes;
    }
  }
  const at::Tensor object =
      at::binary_cross_entropy_with_logits(lines.select(1, 4), object_target, object_weight, {}, at::Reduction::Sum) * share;
  loss.object = object.item<double>();
  loss.total = loss.total + config.object_weight * object;
  return loss;
}

}  // namespace waretwin::train
