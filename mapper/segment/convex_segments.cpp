#include "mapper/segment/convex_segments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {
namespace {

constexpr std::size_t kRows = 16;    // a piece of a parallel loop
constexpr int kFewestForNormal = 6;  // a plane has three unknowns
constexpr std::array<std::pair<int, int>, 4> kBeside = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

// Every n-th row and column, and what is out of range cleared.
cv::Mat thinned(const cv::Mat& depth, int thin, double depth_min, double depth_max) {
  cv::Mat result((depth.rows + thin - 1) / thin, (depth.cols + thin - 1) / thin, CV_32FC1);
  for (int v = 0; v < result.rows; ++v) {
    const auto* from = depth.ptr<float>(v * thin);
    auto* to = result.ptr<float>(v);
    for (int u = 0; u < result.cols; ++u) {
      const float z = from[u * thin];
      to[u] = z > 0.0f && std::isfinite(z) && z >= depth_min && z <= depth_max ? z : 0.0f;
    }
  }
  return result;
}

Intrinsics thinned(const Intrinsics& intrinsics, int thin, int width, int height) {
  return Intrinsics::checked(width, height, intrinsics.fx / thin, intrinsics.fy / thin, intrinsics.cx / thin, intrinsics.cy / thin);
}

class Surface {
 public:
  Surface(const cv::Mat& depth, const Intrinsics& intrinsics, const GeometricConfig& config)
      : config_(config),
        width_(depth.cols),
        height_(depth.rows),
        surface_(fit_surface(depth, intrinsics, config.normal_window_px, config.normal_depth_share)) {}

  std::size_t at(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  }
  bool measured(std::size_t i) const { return point(i).z() > 0.0f; }
  bool has_normal(std::size_t i) const { return !normal(i).isZero(0.0f); }
  const Eigen::Vector3f& point(std::size_t i) const { return surface_[i].p; }
  const Eigen::Vector3f& normal(std::size_t i) const { return surface_[i].normal; }

  bool is_edge(int u, int v) const {
    const std::size_t i = at(u, v);
    return !measured(i) || !has_normal(i) || is_stepped(u, v) || is_concave(u, v);
  }
  // How far j lies before (> 0) or behind the plane of i, in metres.
  float before_plane(std::size_t i, std::size_t j) const { return normal(i).dot(point(j) - point(i)); }
  // A step that is larger than noise and slope explain.
  bool step_between(std::size_t i, std::size_t j) const {
    return std::abs(before_plane(i, j)) > config_.discontinuity_share * point(i).z();
  }

 private:
  template <class Visit>
  bool any_around(int u, int v, int radius, Visit&& visit) const {
    for (int y = std::max(0, v - radius); y <= std::min(height_ - 1, v + radius); ++y) {
      for (int x = std::max(0, u - radius); x <= std::min(width_ - 1, u + radius); ++x) {
        const std::size_t j = at(x, y);
        if ((x != u || y != v) && measured(j) && visit(j)) return true;
      }
    }
    return false;
  }
  bool is_stepped(int u, int v) const {
    const std::size_t i = at(u, v);
    return any_around(u, v, 1, [&](std::size_t j) { return step_between(i, j); });
  }
  bool is_concave(int u, int v) const {
    const std::size_t i = at(u, v);
    const auto margin = static_cast<float>(config_.concave_margin_m), least = static_cast<float>(config_.min_convexity);
    return any_around(u, v, config_.convexity_window_px / 2, [&](std::size_t j) {
      if (!has_normal(j) || normal(i).dot(normal(j)) >= least) return false;
      // Which of both planes lies before the other's point, on the whole: fitted normals turn before the edge does, and by one plane alone
      // a convex edge would look concave from there.
      return (point(j) - point(i)).dot(normal(i) - normal(j)) > margin;
    });
  }

  const GeometricConfig& config_;
  int width_, height_;
  std::vector<SurfacePoint> surface_;
};

// Connected pixels without edges, in the order of their first pixels; small ones are left out.
void connect(const std::vector<char>& edges, int min_pixels, ConvexSegments& segments) {
  std::vector<char> seen = edges;
  std::vector<std::size_t> members;
  const auto width = static_cast<std::size_t>(segments.width);
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start]) continue;
    members.assign(1, start);
    seen[start] = 1;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::size_t i = members[k];
      const auto take = [&](bool inside, std::size_t j) {
        if (!inside || seen[j]) return;
        seen[j] = 1;
        members.push_back(j);
      };
      take(i % width > 0, i - 1);
      take(i % width + 1 < width, i + 1);
      take(i >= width, i - width);
      take(i + width < seen.size(), i + width);
    }
    if (static_cast<int>(members.size()) < min_pixels) continue;
    ++segments.count;
    for (const std::size_t i : members) segments.labels[i] = segments.count;
  }
}

// One ring of edge pixels after the other goes to the segment beside it, of several to the nearest in space.
void grow(const Surface& surface, int rings, ConvexSegments& segments) {
  std::vector<std::pair<std::size_t, std::int32_t>> fresh;
  for (int ring = 0; ring < rings; ++ring) {
    fresh.clear();
    for (int v = 0; v < segments.height; ++v) {
      for (int u = 0; u < segments.width; ++u) {
        const std::size_t i = surface.at(u, v);
        if (segments.labels[i] != 0 || !surface.measured(i)) continue;
        float nearest = std::numeric_limits<float>::infinity();
        std::int32_t label = 0;
        for (const auto& [du, dv] : kBeside) {
          if (u + du < 0 || u + du >= segments.width || v + dv < 0 || v + dv >= segments.height) continue;
          const std::size_t j = surface.at(u + du, v + dv);
          if (segments.labels[j] == 0 || !surface.has_normal(j) || surface.step_between(j, i)) continue;
          const float distance = (surface.point(i) - surface.point(j)).squaredNorm();
          if (distance < nearest || (distance == nearest && segments.labels[j] < label)) {
            nearest = distance;
            label = segments.labels[j];
          }
        }
        if (label != 0) fresh.emplace_back(i, label);
      }
    }
    if (fresh.empty()) return;
    for (const auto& [i, label] : fresh) segments.labels[i] = label;
  }
}

}  // namespace

std::vector<SurfacePoint> fit_surface(const cv::Mat& depth, const Intrinsics& intrinsics, int window_px, double depth_share) {
  WARETWIN_CHECK(depth.type() == CV_32FC1 && window_px % 2 == 1, "a depth picture and an odd window");
  const int radius = window_px / 2;
  std::vector<SurfacePoint> surface(depth.total());
  parallel_for(static_cast<std::size_t>(depth.rows), kRows, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const float z = depth.at<float>(v, u);
        if (!(z > 0.0f)) continue;
        SurfacePoint& point = surface[static_cast<std::size_t>(v) * static_cast<std::size_t>(depth.cols) + static_cast<std::size_t>(u)];
        const Eigen::Vector3d ray = intrinsics.ray(u, v);
        point.p = (z * ray).cast<float>();
        const auto reach = static_cast<float>(depth_share * z);
        // Least squares of 1/z = a du + b dv + c over the window.
        float n = 0, su = 0, sv = 0, suu = 0, suv = 0, svv = 0, sw = 0, swu = 0, swv = 0;
        for (int y = std::max(0, v - radius); y <= std::min(depth.rows - 1, v + radius); ++y) {
          const auto* row = depth.ptr<float>(y);
          const auto dv = static_cast<float>(y - v);
          for (int x = std::max(0, u - radius); x <= std::min(depth.cols - 1, u + radius); ++x) {
            if (!(row[x] > 0.0f) || std::abs(row[x] - z) > reach) continue;
            const auto du = static_cast<float>(x - u);
            const float w = 1.0f / row[x];
            n += 1.0f, su += du, sv += dv, suu += du * du, suv += du * dv, svv += dv * dv;
            sw += w, swu += w * du, swv += w * dv;
          }
        }
        if (n < kFewestForNormal) continue;
        const double uu = suu - su * su / n, uv = suv - su * sv / n, vv = svv - sv * sv / n;
        const double wu = swu - sw * su / n, wv = swv - sw * sv / n;
        const double determinant = uu * vv - uv * uv;
        if (!(determinant > 1e-3 * n * n)) continue;  // pixels in one line
        const double a = (wu * vv - wv * uv) / determinant, b = (wv * uu - wu * uv) / determinant;
        const double c = (sw - a * su - b * sv) / n;  // 1/z at the pixel itself
        // On the plane p.m = 1 it is 1/z = m.ray, and the ray is linear in the pixel; m points away from the camera.
        const Eigen::Vector3d m(a * intrinsics.fx, b * intrinsics.fy, c - a * (u - intrinsics.cx) - b * (v - intrinsics.cy));
        if (!(m.squaredNorm() > 0.0) || !(c > 0.0)) continue;
        point.p = (ray / c).cast<float>();
        point.normal = (-m.normalized()).cast<float>();
      }
    }
  });
  return surface;
}

ConvexSegments find_convex_segments(const cv::Mat& depth, const Intrinsics& intrinsics, double depth_min, double depth_max,
                                    const GeometricConfig& config) {
  WARETWIN_CHECK(depth.cols == intrinsics.width && depth.rows == intrinsics.height, "depth and intrinsics are of one size");
  const cv::Mat few = thinned(depth, config.thin, depth_min, depth_max);
  const Surface surface(few, thinned(intrinsics, config.thin, few.cols, few.rows), config);
  ConvexSegments segments{few.cols, few.rows, 0, std::vector<std::int32_t>(few.total(), 0)};
  std::vector<char> edges(few.total());
  parallel_for(static_cast<std::size_t>(few.rows), kRows, [&](std::size_t begin, std::size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < few.cols; ++u) edges[surface.at(u, v)] = surface.is_edge(u, v) ? 1 : 0;
    }
  });
  connect(edges, config.min_segment_px, segments);
  grow(surface, config.grow_px, segments);
  return segments;
}

}  // namespace waretwin
