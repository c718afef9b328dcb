#include "sim/object_views.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "sim/pixel_extent.h"
#include "sim/pixel_rays.h"

namespace waretwin {

namespace {

// Metres before the camera; what is nearer has no place in a picture.
constexpr float kNear = 0.01f;
// Beyond the picture an object gets about as many rays as this: enough for its area to within half a percent.
constexpr double kRaysBeyond = 16384.0;
constexpr int kRowsAtOnce = 16;

// Where on the picture's plane a box may show. The corners of the box and the points where its edges pass the near plane span whatever of
// it lies before the camera.
class BoxProjection {
 public:
  explicit BoxProjection(const PictureRays& rays)
      : intrinsics_(rays.intrinsics),
        whole_(-intrinsics_.width, -intrinsics_.height, 3 * intrinsics_.width, 3 * intrinsics_.height),
        X_CW_(rays.X_WC.inverse().cast<float>()) {
    measure(rays);
  }

  cv::Rect whole() const { return whole_; }
  const Eigen::Isometry3f& X_CW() const { return X_CW_; }

  cv::Rect operator()(const Eigen::AlignedBox3f& box_W) const {
    if (box_W.isEmpty()) return {};
    std::array<Eigen::Vector3f, 8> corners;
    for (int i = 0; i < 8; ++i)
      corners[static_cast<std::size_t>(i)] = X_CW_ * box_W.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i));
    Eigen::AlignedBox2d on_plane;
    float nearest = std::numeric_limits<float>::infinity();
    const auto add = [&](const Eigen::Vector3f& p_C) {
      on_plane.extend(intrinsics_.project(p_C.cast<double>()));
      nearest = std::min(nearest, p_C.z());
    };
    for (std::size_t i = 0; i < 8; ++i) {
      if (corners[i].z() >= kNear) add(corners[i]);
      for (const std::size_t bit : {1u, 2u, 4u}) {
        const std::size_t j = i | bit;
        if (j == i || (corners[i].z() < kNear) == (corners[j].z() < kNear)) continue;
        Eigen::Vector3f p_C = corners[i] + (corners[j] - corners[i]) * (kNear - corners[i].z()) / (corners[j].z() - corners[i].z());
        p_C.z() = kNear;
        add(p_C);
      }
    }
    if (on_plane.isEmpty()) return {};
    const double margin = bend_px_ + shift_px_m_ / static_cast<double>(nearest) + 1.0;
    const Eigen::Vector2d low = on_plane.min().array() - margin, high = on_plane.max().array() + margin;
    const auto clamped = [](double value, int first, int length) {
      return static_cast<int>(std::clamp(value, static_cast<double>(first), static_cast<double>(first + length)));
    };
    const int u0 = clamped(std::floor(low.x()), whole_.x, whole_.width), u1 = clamped(std::ceil(high.x()) + 1.0, whole_.x, whole_.width);
    const int v0 = clamped(std::floor(low.y()), whole_.y, whole_.height), v1 = clamped(std::ceil(high.y()) + 1.0, whole_.y, whole_.height);
    return {u0, v0, u1 - u0, v1 - v0};
  }

 private:
  // How far the rays of the picture go from the pinhole's: a lens and a moving camera bend evenly, so that a grid of them tells.
  void measure(const PictureRays& rays) {
    constexpr int kStep = 16;
    const Eigen::Vector3f origin = rays.X_WC.translation().cast<float>();
    float shift = 0.0f;
    for (int v = 0;; v = std::min(v + kStep, intrinsics_.height - 1)) {
      for (int u = 0;; u = std::min(u + kStep, intrinsics_.width - 1)) {
        const Ray ray = rays.at(u, v);
        const Eigen::Vector3f d_C = X_CW_.linear() * ray.direction;
        WARETWIN_CHECK(d_C.z() > 0.0f, "the rays of a picture go forward");
        const Eigen::Vector2d at = intrinsics_.project(d_C.cast<double>());
        bend_px_ = std::max({bend_px_, std::abs(at.x() - u), std::abs(at.y() - v)});
        shift = std::max(shift, (ray.origin - origin).norm());
        if (u == intrinsics_.width - 1) break;
      }
      if (v == intrinsics_.height - 1) break;
    }
    // Sideways, and as much again for what lies aside when the camera moves forward.
    shift_px_m_ = 2.0 * std::max(intrinsics_.fx, intrinsics_.fy) * static_cast<double>(shift);
  }

  Intrinsics intrinsics_;
  cv::Rect whole_;
  Eigen::Isometry3f X_CW_;
  double bend_px_ = 0.0;     // pixels
  double shift_px_m_ = 0.0;  // pixels times metres of depth
};

bool has_part_behind(const RayCaster& ray_caster, int instance, const Eigen::Isometry3f& X_CW) {
  const Scene& scene = ray_caster.scene();
  const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[static_cast<std::size_t>(instance)].mesh)];
  const Eigen::Affine3f X_CM = X_CW * ray_caster.transform(instance);
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](std::uint32_t corner) { return (X_CM * mesh.positions[corner]).z() < kNear; });
}

// An object that is looked at.
struct Subject {
  int object = 0;   // index into Scene::objects
  cv::Rect region;  // where its amodal pixels are
  cv::Rect inside;  // the part of it in the picture
  cv::Mat mask;     // of `inside`
  bool behind = false;
  int step = 1;
};

// A part of the work: rows of the picture, or a part of the plane beyond it.
struct Piece {
  std::size_t subject = 0;
  cv::Rect rect;
  bool beyond = false;
  PixelExtent found;
};

// The part of `region` beyond the picture in up to four rectangles.
std::vector<cv::Rect> beyond(const cv::Rect& region, const cv::Size& picture) {
  const int left = region.x, right = region.x + region.width, top = region.y, bottom = region.y + region.height;
  const int v0 = std::clamp(0, top, bottom), v1 = std::clamp(picture.height, top, bottom);
  const int u0 = std::clamp(0, left, right), u1 = std::clamp(picture.width, left, right);
  std::vector<cv::Rect> parts;
  for (const cv::Rect& part : {cv::Rect(left, top, right - left, v0 - top), cv::Rect(left, v0, u0 - left, v1 - v0),
                               cv::Rect(u1, v0, right - u1, v1 - v0), cv::Rect(left, v1, right - left, bottom - v1)}) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

class Look {
 public:
  Look(const RayCaster& ray_caster, const PictureRays& rays, const cv::Mat& instances)
      : ray_caster_(ray_caster), rays_(rays), instances_(instances) {}

  // Pixel by pixel; those that show the object need no ray.
  void inside(Subject& subject, Piece& piece) const {
    const int id = ray_caster_.scene().objects[static_cast<std::size_t>(subject.object)].id;
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<int> columns;
    for (int v = piece.rect.y; v < piece.rect.y + piece.rect.height; ++v) {
      const auto* ids = instances_.ptr<std::uint16_t>(v);
      auto* mask = subject.mask.ptr<std::uint8_t>(v - subject.inside.y);
      rays.clear();
      columns.clear();
      for (int u = piece.rect.x; u < piece.rect.x + piece.rect.width; ++u) {
        if (ids[u] == id) {
          mask[u - subject.inside.x] = 255;
          piece.found.add(u, v);
        } else {
          rays.push_back(rays_.at(u, v));
          columns.push_back(u);
        }
      }
      hits.resize(rays.size());
      ray_caster_.cast_object(subject.object, rays, hits, Coherence::kCoherent);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].valid()) continue;
        mask[columns[i] - subject.inside.x] = 255;
        piece.found.add(columns[i], v);
      }
    }
  }

  // Cell by cell, each judged by its middle.
  void beyond(const Subject& subject, Piece& piece) const {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<cv::Rect> cells;
    const int right = piece.rect.x + piece.rect.width, bottom = piece.rect.y + piece.rect.height;
    for (int v = piece.rect.y; v < bottom; v += subject.step) {
      rays.clear();
      cells.clear();
      for (int u = piece.rect.x; u < right; u += subject.step) {
        cells.emplace_back(u, v, std::min(subject.step, right - u), std::min(subject.step, bottom - v));
        rays.push_back(rays_.at(u + cells.back().width / 2, v + cells.back().height / 2));
      }
      hits.resize(rays.size());
      ray_caster_.cast_object(subject.object, rays, hits, Coherence::kCoherent);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        if (hits[i].valid()) piece.found.add(cells[i]);
      }
    }
  }

 private:
  const RayCaster& ray_caster_;
  const PictureRays& rays_;
  const cv::Mat& instances_;
};

// Objects whose bounds are in sight, with the region to look for each.
std::vector<Subject> find_subjects(const RayCaster& ray_caster, const PictureRays& rays, const std::map<int, PixelExtent>& visible) {
  const Scene& scene = ray_caster.scene();
  const BoxProjection projection(rays);
  std::vector<Subject> all(scene.objects.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const int object = scene.instances[i].object;
    if (object < 0) continue;
    Subject& subject = all[static_cast<std::size_t>(object)];
    const Eigen::AlignedBox3f bounds = ray_caster.bounds(static_cast<int>(i));
    subject.region |= projection(bounds);
    if (bounds.isEmpty() || subject.behind) continue;
    // How deep the box may reach at least.
    const Eigen::Vector3f ahead_W = projection.X_CW().linear().row(2).transpose();
    const float middle = (projection.X_CW() * bounds.center()).z(), reach = 0.5f * ahead_W.cwiseAbs().dot(bounds.sizes());
    subject.behind = middle - reach < kNear && has_part_behind(ray_caster, static_cast<int>(i), projection.X_CW());
  }
  std::vector<Subject> subjects;
  for (std::size_t object = 0; object < all.size(); ++object) {
    Subject& subject = all[object];
    subject.object = static_cast<int>(object);
    const auto seen = visible.find(scene.objects[object].id);
    if (seen != visible.end()) subject.region |= seen->second.box();
    subject.region &= projection.whole();
    if (!subject.region.empty()) subjects.push_back(std::move(subject));
  }
  return subjects;
}

}  // namespace

PictureRays pinhole_rays(const Intrinsics& intrinsics, const Pose& X_WC, float time) {
  return {intrinsics, X_WC, [pixels = PixelRays(intrinsics, X_WC, time)](int u, int v) { return pixels.at(u, v); }};
}

std::vector<ObjectView> object_views(const RayCaster& ray_caster, const PictureRays& rays, const cv::Mat& instances) {
  const cv::Rect picture(0, 0, rays.intrinsics.width, rays.intrinsics.height);
  WARETWIN_CHECK(instances.type() == CV_16UC1 && instances.size() == picture.size(), "the picture's instance image");
  const std::map<int, PixelExtent> visible = extents_of(instances);
  std::vector<Subject> subjects = find_subjects(ray_caster, rays, visible);

  std::vector<Piece> pieces;
  const auto add_rows = [&](std::size_t subject, const cv::Rect& rect, int rows_at_once, bool is_beyond) {
    for (int v = 0; v < rect.height; v += rows_at_once) {
      pieces.push_back({subject, cv::Rect(rect.x, rect.y + v, rect.width, std::min(rows_at_once, rect.height - v)), is_beyond, {}});
    }
  };
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    Subject& subject = subjects[i];
    subject.inside = subject.region & picture;
    if (!subject.inside.empty()) subject.mask = cv::Mat::zeros(subject.inside.size(), CV_8UC1);
    add_rows(i, subject.inside, kRowsAtOnce, false);
    double area = 0.0;
    const std::vector<cv::Rect> parts = beyond(subject.region, picture.size());
    for (const cv::Rect& part : parts) area += part.area();
    subject.step = std::max(1, static_cast<int>(std::ceil(std::sqrt(area / kRaysBeyond))));
    for (const cv::Rect& part : parts) add_rows(i, part, kRowsAtOnce * subject.step, true);
  }
  const Look look(ray_caster, rays, instances);
  parallel_for(pieces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (pieces[i].beyond) {
        look.beyond(subjects[pieces[i].subject], pieces[i]);
      } else {
        look.inside(subjects[pieces[i].subject], pieces[i]);
      }
    }
  });

  std::vector<PixelExtent> inside(subjects.size()), total(subjects.size());
  for (const Piece& piece : pieces) {
    total[piece.subject].add(piece.found);
    if (!piece.beyond) inside[piece.subject].add(piece.found);
  }
  const cv::Rect whole(-picture.width, -picture.height, 3 * picture.width, 3 * picture.height);
  std::vector<ObjectView> views;
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    if (total[i].pixels == 0) continue;
    ObjectView view;
    view.id = ray_caster.scene().objects[static_cast<std::size_t>(subjects[i].object)].id;
    const auto seen = visible.find(view.id);
    if (seen != visible.end()) {
      view.visible_px = static_cast<int>(seen->second.pixels);
      view.visible_box = seen->second.box();
    }
    view.amodal_px = static_cast<int>(inside[i].pixels);
    view.amodal_px_total = total[i].pixels;
    view.amodal_box = total[i].box();
    view.mask_box = inside[i].box();
    if (view.amodal_px > 0) view.amodal_mask = subjects[i].mask(view.mask_box - subjects[i].inside.tl()).clone();
    view.beyond_step = subjects[i].step;
    view.crosses_camera_plane = subjects[i].behind;
    view.leaves_margin = view.amodal_box.x == whole.x || view.amodal_box.y == whole.y || view.amodal_box.br().x == whole.br().x ||
                         view.amodal_box.br().y == whole.br().y;
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace waretwin
