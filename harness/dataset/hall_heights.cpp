#include "harness/dataset/hall_heights.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace waretwin {

namespace {

constexpr float kFlat = 0.03f;  // what is lower is the floor, or painted on it

}  // namespace

double floor_of(double lowest) { return lowest < 0.0 && lowest > -1.0 ? 0.0 : lowest; }

HallHeights::HallHeights(const Scene& scene, double cell_m, double below_m) : cell_(cell_m) {
  const std::vector<bool> moving = scene.moves();
  Eigen::AlignedBox3f bounds;
  std::vector<std::vector<Eigen::Vector3f>> corners(scene.instances.size());
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    if (moving[i]) continue;
    const Instance& instance = scene.instances[i];
    for (const Eigen::Vector3f& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].positions) {
      corners[i].push_back(instance.X_WM * p);
      bounds.extend(corners[i].back());
    }
  }
  if (bounds.isEmpty()) return;
  floor_ = floor_of(static_cast<double>(bounds.min().z()));
  area_ = Eigen::AlignedBox2d(bounds.min().head<2>().cast<double>(), bounds.max().head<2>().cast<double>());
  // A hall on a wide plain: coarser cells, as many as fit into a few megabytes.
  constexpr double kMostCells = 4e6;
  cell_ = std::max(cell_, std::sqrt(area_.volume() / kMostCells));
  width_ = static_cast<int>(std::ceil(area_.sizes().x() / cell_)) + 1;
  height_ = static_cast<int>(std::ceil(area_.sizes().y() / cell_)) + 1;
  heights_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0f);
  taken_.assign(heights_.size(), false);

  const auto top = static_cast<float>(floor_ + below_m), bottom = static_cast<float>(floor_) + kFlat;
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)];
    if (corners[i].empty()) continue;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      const std::array<Eigen::Vector3f, 3> p = {corners[i][mesh.triangles[t]], corners[i][mesh.triangles[t + 1]],
                                                corners[i][mesh.triangles[t + 2]]};
      const float low = std::min({p[0].z(), p[1].z(), p[2].z()}), high = std::max({p[0].z(), p[1].z(), p[2].z()});
      if (high < bottom || low > top) continue;
      // By samples half a cell apart: triangles are small or flat.
      const float longest = std::max({(p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[0] - p[2]).norm()});
      const int steps = std::clamp(static_cast<int>(std::ceil(2.0 * static_cast<double>(longest) / cell_)), 1, 2000);
      for (int a = 0; a <= steps; ++a) {
        for (int b = 0; a + b <= steps; ++b) {
          const float wa = static_cast<float>(a) / static_cast<float>(steps), wb = static_cast<float>(b) / static_cast<float>(steps);
          const Eigen::Vector3f q = wa * p[0] + wb * p[1] + (1.0f - wa - wb) * p[2];
          std::size_t index = 0;
          if (q.z() > top || !cell(q.head<2>().cast<double>(), index)) continue;
          heights_[index] = std::max(heights_[index], q.z() - static_cast<float>(floor_));
        }
      }
    }
  }
}

bool HallHeights::cell(const Eigen::Vector2d& p_W, std::size_t& index) const {
  const Eigen::Vector2d at = (p_W - area_.min()) / cell_;
  if (!(at.x() >= 0.0 && at.y() >= 0.0 && at.x() < width_ && at.y() < height_)) return false;
  index = static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(at.x());
  return true;
}

double HallHeights::at(const Eigen::Vector2d& p_W) const {
  std::size_t index = 0;
  return floor_ + (cell(p_W, index) ? static_cast<double>(heights_[index]) : 0.0);
}

bool HallHeights::is_free(const Eigen::Vector2d& centre_W, const Eigen::Vector2d& size, double yaw) const {
  const Eigen::Rotation2Dd turn(yaw);
  const int nx = static_cast<int>(std::ceil(size.x() / cell_)) + 1, ny = static_cast<int>(std::ceil(size.y() / cell_)) + 1;
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      const Eigen::Vector2d p =
          centre_W + turn * Eigen::Vector2d((static_cast<double>(i) / nx - 0.5) * size.x(), (static_cast<double>(j) / ny - 0.5) * size.y());
      std::size_t index = 0;
      if (!cell(p, index) || taken_[index] || heights_[index] > kFlat) return false;
    }
  }
  return true;
}

void HallHeights::take(const Eigen::Vector2d& p_W, double radius) {
  const int reach = static_cast<int>(std::ceil(radius / cell_));
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      const Eigen::Vector2d offset(i * cell_, j * cell_);
      std::size_t index = 0;
      if (offset.norm() <= radius && cell(p_W + offset, index)) taken_[index] = true;
    }
  }
}

}  // namespace waretwin
