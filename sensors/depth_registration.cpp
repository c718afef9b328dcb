#include "sensors/depth_registration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "sensors/bulk_normals.h"

namespace waretwin {

namespace {

struct Corner {
  float u = 0.0f, v = 0.0f;  // pixel of the view
  float z = 0.0f;            // depth in the view; 0 = nothing
  float native = 0.0f;       // depth that was measured
};

bool belong_together(const Corner& a, const Corner& b, const Corner& c) {
  if (a.z == 0.0f || b.z == 0.0f || c.z == 0.0f) return false;
  const auto [low, high] = std::minmax({a.native, b.native, c.native});
  return high - low <= 0.05f * low + 0.005f;
}

// Nearest depth into the rows [top, bottom) of `out`; 1 / z is linear over the picture of a plane.
void draw(const Corner& a, const Corner& b, const Corner& c, int top, int bottom, cv::Mat& out) {
  const float area = (b.u - a.u) * (c.v - a.v) - (b.v - a.v) * (c.u - a.u);
  if (std::abs(area) < 1e-9f) return;
  const float scale = 1.0f / area;
  const int v0 = std::max(top, static_cast<int>(std::ceil(std::min({a.v, b.v, c.v}))));
  const int v1 = std::min(bottom - 1, static_cast<int>(std::floor(std::max({a.v, b.v, c.v}))));
  const int u0 = std::max(0, static_cast<int>(std::ceil(std::min({a.u, b.u, c.u}))));
  const int u1 = std::min(out.cols - 1, static_cast<int>(std::floor(std::max({a.u, b.u, c.u}))));
  const float ia = 1.0f / a.z, ib = 1.0f / b.z, ic = 1.0f / c.z;
  // A pixel on the border of two triangles belongs to both; they agree there.
  constexpr float kEdge = -1e-4f;
  for (int v = v0; v <= v1; ++v) {
    auto* row = out.ptr<float>(v);
    const float y = static_cast<float>(v) - a.v;
    for (int u = u0; u <= u1; ++u) {
      const float x = static_cast<float>(u) - a.u;
      const float wb = (x * (c.v - a.v) - y * (c.u - a.u)) * scale;
      const float wc = (y * (b.u - a.u) - x * (b.v - a.v)) * scale;
      const float wa = 1.0f - wb - wc;
      if (wa < kEdge || wb < kEdge || wc < kEdge) continue;
      const float z = 1.0f / (wa * ia + wb * ib + wc * ic);
      if (z < row[u]) row[u] = z;
    }
  }
}

}  // namespace

DepthRegistration::DepthRegistration(const cv::Mat& rays, const Pose& X_CD, const Lens& view) : rays_(rays), X_CD_(X_CD), view_(view) {
  WARETWIN_CHECK(rays.type() == CV_32FC3, "rays are three floats a pixel");
}

cv::Mat DepthRegistration::operator()(const cv::Mat& native) const {
  WARETWIN_CHECK(native.type() == CV_32FC1 && native.size() == rays_.size(), "depth of the depth camera's size");
  const int rows = native.rows, cols = native.cols;
  const auto stride = static_cast<std::size_t>(cols);
  std::vector<Corner> corners(native.total());
  struct Reach {
    float low = std::numeric_limits<float>::infinity(), high = -std::numeric_limits<float>::infinity();
  };
  std::vector<Reach> reach(static_cast<std::size_t>(rows));
  const Eigen::Matrix3f R = X_CD_.linear().cast<float>();
  const Eigen::Vector3f p = X_CD_.translation().cast<float>();
  const Intrinsics& k = view_.intrinsics();
  const bool pinhole = view_.distortion().is_none();
  parallel_for(static_cast<std::size_t>(rows), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto* depth = native.ptr<float>(static_cast<int>(v));
      const auto* ray = rays_.ptr<cv::Vec3f>(static_cast<int>(v));
      for (int u = 0; u < cols; ++u) {
        if (depth[u] == 0.0f || ray[u][2] == 0.0f) continue;
        const Eigen::Vector3f point = R * (depth[u] * Eigen::Vector3f(ray[u][0], ray[u][1], 1.0f)) + p;
        if (!(point.z() > 1e-3f)) continue;
        Corner corner;
        if (pinhole) {
          corner.u = static_cast<float>(k.fx) * point.x() / point.z() + static_cast<float>(k.cx);
          corner.v = static_cast<float>(k.fy) * point.y() / point.z() + static_cast<float>(k.cy);
        } else {
          const auto pixel = view_.project(point.cast<double>());
          if (!pixel) continue;
          corner.u = static_cast<float>(pixel->x());
          corner.v = static_cast<float>(pixel->y());
        }
        // Far outside: no triangle of use, and no overflow of pixel numbers.
        if (!(std::abs(corner.u) < 1e5f && std::abs(corner.v) < 1e5f)) continue;
        corner.z = point.z();
        corner.native = depth[u];
        corners[v * stride + static_cast<std::size_t>(u)] = corner;
        reach[v].low = std::min(reach[v].low, corner.v);
        reach[v].high = std::max(reach[v].high, corner.v);
      }
    }
  });

  cv::Mat out(k.height, k.width, CV_32FC1, cv::Scalar(std::numeric_limits<float>::infinity()));
  // Bands of the view are drawn apart: each takes the triangles that reach into it.
  parallel_for(static_cast<std::size_t>(k.height), 48, [&](std::size_t begin, std::size_t end) {
    const auto top = static_cast<int>(begin), bottom = static_cast<int>(end);
    const auto top_f = static_cast<float>(top), bottom_f = static_cast<float>(bottom);
    for (std::size_t v = 0; v + 1 < static_cast<std::size_t>(rows); ++v) {
      if (std::max(reach[v].high, reach[v + 1].high) < top_f || std::min(reach[v].low, reach[v + 1].low) > bottom_f) continue;
      const Corner* above = &corners[v * stride];
      const Corner* below = above + stride;
      for (std::size_t u = 0; u + 1 < stride; ++u) {
        const Corner &a = above[u], &b = above[u + 1], &c = below[u], &d = below[u + 1];
        const auto [low, high] = std::minmax({a.v, b.v, c.v, d.v});
        if (high < top_f || low > bottom_f) continue;
        if (belong_together(a, b, d)) draw(a, b, d, top, bottom, out);
        if (belong_together(a, d, c)) draw(a, d, c, top, bottom, out);
      }
    }
    for (int v = top; v < bottom; ++v) {
      auto* row = out.ptr<float>(v);
      for (int u = 0; u < out.cols; ++u) {
        const float millimetres = row[u] * 1000.0f;
        row[u] = millimetres <= 65535.0f ? nearest_whole(millimetres) * 0.001f : 0.0f;
      }
    }
  });
  return out;
}

}  // namespace waretwin
