#include "mapper/integrate/point_groups.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"

namespace waretwin {

namespace {

// Voxels are numbered from a block's corner 4096 voxels off the camera: 13 bits an axis.
constexpr int kHalfSpan = 4096;
constexpr int kReach = 4000;
constexpr int kLabelBits = 25;
constexpr std::size_t kBandRows = 16;

// Partial sums over points of one voxel and one label within one band of rows.
struct Sums {
  std::uint64_t key = 0;  // block, voxel in the block, label
  float weight = 0.0f, x = 0.0f, y = 0.0f, z = 0.0f;
  std::uint32_t points = 0, red = 0, green = 0, blue = 0;
};

std::uint64_t make_key(int x, int y, int z, std::int32_t label) {
  const auto u = [](int i) { return static_cast<std::uint64_t>(i); };
  const std::uint64_t block = u(x >> 3) << 20 | u(y >> 3) << 10 | u(z >> 3);
  const std::uint64_t voxel = u(z & 7) << 6 | u(y & 7) << 3 | u(x & 7);
  return (block << 9 | voxel) << kLabelBits | static_cast<std::uint64_t>(label);
}

Eigen::Vector3i voxel_of_key(std::uint64_t key) {
  const auto bits = [&](int shift, int count) { return static_cast<int>(key >> shift & ((1u << count) - 1)); };
  const int v = kLabelBits, b = kLabelBits + 9;
  return {bits(b + 20, 10) << 3 | bits(v, 3), bits(b + 10, 10) << 3 | bits(v + 3, 3), bits(b, 10) << 3 | bits(v + 6, 3)};
}

std::int32_t label_of_key(std::uint64_t key) { return static_cast<std::int32_t>(key & ((1u << kLabelBits) - 1)); }

// Open addressing over the sums of one band. What comes out is in order of first arrival, whatever the table's layout.
class BandTable {
 public:
  explicit BandTable(std::size_t most) {
    std::size_t size = 64;
    while (size < most + most / 2) size *= 2;
    slots_.assign(size, kEmpty);
    mask_ = size - 1;
  }
  Sums& find(std::uint64_t key) {
    std::size_t slot = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ULL) >> 32) & mask_;
    while (true) {
      const std::uint32_t at = slots_[slot];
      if (at == kEmpty) break;
      if (sums_[at].key == key) return sums_[at];
      slot = (slot + 1) & mask_;
    }
    slots_[slot] = static_cast<std::uint32_t>(sums_.size());
    sums_.emplace_back().key = key;
    return sums_.back();
  }
  std::vector<Sums> take() { return std::move(sums_); }

 private:
  static constexpr std::uint32_t kEmpty = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> slots_;
  std::vector<Sums> sums_;
  std::size_t mask_ = 0;
};

struct Grid {
  Eigen::Vector3i origin;  // voxel of the volume that has number (0, 0, 0)
  Eigen::Vector3f shift;   // the camera's centre in voxels from the block's corner below it, in [0, 8)
};

// Rounds down, in operations that every x86-64 does four at a time.
inline int number(float position) {
  const int cut = static_cast<int>(position);
  return cut - static_cast<int>(static_cast<float>(cut) > position) + kHalfSpan;
}

Grid grid_around(const Eigen::Vector3d& p_WC, double voxel_m) {
  Grid grid;
  for (int k = 0; k < 3; ++k) {
    const double camera = p_WC[k] / voxel_m;
    if (!(std::abs(camera) < 8e6))
      throw Error("camera at " + std::to_string(p_WC[k]) +
                  " m is outside the map; expected a position within 8 million voxels of the origin");
    const int corner = static_cast<int>(std::floor(camera / 8.0)) * 8;
    grid.origin[k] = corner - kHalfSpan;
    grid.shift[k] = static_cast<float>(camera - corner);
  }
  return grid;
}

// Scratch of one row.
struct Row {
  explicit Row(std::size_t width) : x(width), y(width), z(width), weight(width), ix(width), iy(width), iz(width) {}
  std::vector<float> x, y, z, weight;  // position in voxels from the camera's centre, axes of the world
  std::vector<int> ix, iy, iz;         // number of its voxel
};

class Grouping {
 public:
  Grouping(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels, const Pose& X_WC,
           const TsdfConfig& config)
      : frame_(frame), intrinsics_(intrinsics), labels_(labels), config_(config), grid_(grid_around(X_WC.translation(), config.voxel_m)) {
    R_ = X_WC.linear();
    const auto width = static_cast<std::size_t>(intrinsics.width);
    columns_.resize(width);
    for (std::size_t u = 0; u < width; ++u) columns_[u] = static_cast<float>((static_cast<double>(u) - intrinsics.cx) / intrinsics.fx);
    double longest = 1.0;
    for (const double u : {0.0, intrinsics.width - 1.0}) {
      for (const double v : {0.0, intrinsics.height - 1.0}) longest = std::max(longest, intrinsics.ray(u, v).norm());
    }
    max_depth_ = static_cast<float>(std::min(config.max_depth_m, kReach * config.voxel_m / longest));
  }

  std::vector<Sums> band(std::size_t begin, std::size_t end) const {
    const auto width = static_cast<std::size_t>(intrinsics_.width);
    BandTable table((end - begin) * width);
    Row row(width);
    for (std::size_t v = begin; v < end; ++v) {
      back_project(v, row);
      add_runs(v, row, table);
    }
    return table.take();
  }

  std::vector<PointGroup> merge(const std::vector<std::vector<Sums>>& bands) const;

 private:
  void back_project(std::size_t v, Row& row) const {
    const auto width = static_cast<std::size_t>(intrinsics_.width);
    const float* depth = frame_.depth.ptr<float>(static_cast<int>(v));
    // In voxels: position = depth * (a + b * column).
    const double per_voxel = 1.0 / config_.voxel_m;
    const Eigen::Vector3f a =
        ((R_.col(1) * ((static_cast<double>(v) - intrinsics_.cy) / intrinsics_.fy) + R_.col(2)) * per_voxel).cast<float>();
    const Eigen::Vector3f b = (R_.col(0) * per_voxel).cast<float>();
    const float ax = a.x(), ay = a.y(), az = a.z(), bx = b.x(), by = b.y(), bz = b.z();
    const float sx = grid_.shift.x(), sy = grid_.shift.y(), sz = grid_.shift.z();
    const float max_depth = max_depth_;
    const float* columns = columns_.data();
    float *x = row.x.data(), *y = row.y.data(), *z = row.z.data(), *weight = row.weight.data();
    int *ix = row.ix.data(), *iy = row.iy.data(), *iz = row.iz.data();
    const bool inverse_square = config_.inverse_square_weight;
    for (std::size_t u = 0; u < width; ++u) {
      // False for NaN too.
      const bool valid = (depth[u] > 0.0f) & (depth[u] <= max_depth);
      const float d = valid ? depth[u] : 0.0f;
      const float column = columns[u];
      const float px = d * (ax + bx * column), py = d * (ay + by * column), pz = d * (az + bz * column);
      x[u] = px;
      y[u] = py;
      z[u] = pz;
      ix[u] = number(px + sx);
      iy[u] = number(py + sy);
      iz[u] = number(pz + sz);
      const float one = valid ? 1.0f : 0.0f;
      weight[u] = inverse_square ? one / (valid ? d * d : 1.0f) : one;
    }
  }

  void add_runs(std::size_t v, const Row& row, BandTable& table) const {
    const auto width = static_cast<std::size_t>(intrinsics_.width);
    const std::uint8_t* bgr = frame_.colour.ptr<std::uint8_t>(static_cast<int>(v));
    const std::int32_t* labels = labels_.empty() ? nullptr : labels_.data() + v * width;
    std::size_t u = 0;
    while (u < width) {
      if (row.weight[u] == 0.0f) {
        ++u;
        continue;
      }
      const int ix = row.ix[u], iy = row.iy[u], iz = row.iz[u];
      const std::int32_t label = labels ? labels[u] : 0;
      WARETWIN_CHECK(label >= 0 && label < (1 << kLabelBits), "label out of range");
      float weight = 0.0f, x = 0.0f, y = 0.0f, z = 0.0f;
      std::uint32_t red = 0, green = 0, blue = 0;
      const std::size_t begin = u;
      do {
        const float w = row.weight[u];
        weight += w;
        x += w * row.x[u];
        y += w * row.y[u];
        z += w * row.z[u];
        blue += bgr[3 * u];
        green += bgr[3 * u + 1];
        red += bgr[3 * u + 2];
        ++u;
      } while (u < width && row.ix[u] == ix && row.iy[u] == iy && row.iz[u] == iz && row.weight[u] != 0.0f &&
               (!labels || labels[u] == label));
      Sums& sums = table.find(make_key(ix, iy, iz, label));
      sums.weight += weight;
      sums.x += x;
      sums.y += y;
      sums.z += z;
      sums.points += static_cast<std::uint32_t>(u - begin);
      sums.red += red;
      sums.green += green;
      sums.blue += blue;
    }
  }

  const RgbdFrame& frame_;
  const Intrinsics& intrinsics_;
  const std::vector<std::int32_t>& labels_;
  const TsdfConfig& config_;
  Grid grid_;
  Eigen::Matrix3d R_;
  std::vector<float> columns_;
  float max_depth_ = 0.0f;
};

std::vector<PointGroup> Grouping::merge(const std::vector<std::vector<Sums>>& bands) const {
  struct Reference {
    std::uint64_t key;
    const Sums* sums;
    std::uint32_t order;
  };
  std::size_t count = 0;
  for (const auto& band : bands) count += band.size();
  std::vector<Reference> order;
  order.reserve(count);
  for (const auto& band : bands) {
    for (const Sums& sums : band) order.push_back({sums.key, &sums, static_cast<std::uint32_t>(order.size())});
  }
  std::sort(order.begin(), order.end(),
            [](const Reference& a, const Reference& b) { return a.key != b.key ? a.key < b.key : a.order < b.order; });

  std::vector<PointGroup> groups;
  groups.reserve(count);
  for (std::size_t i = 0; i < order.size();) {
    const std::uint64_t voxel = order[i].key >> kLabelBits;
    double weight = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::uint64_t points = 0, red = 0, green = 0, blue = 0, most = 0;
    std::int32_t majority = 0;
    while (i < order.size() && order[i].key >> kLabelBits == voxel) {
      const std::uint64_t key = order[i].key;
      std::uint64_t points_of_label = 0;
      for (; i < order.size() && order[i].key == key; ++i) {
        const Sums& s = *order[i].sums;
        weight += s.weight;
        sum += Eigen::Vector3f(s.x, s.y, s.z).cast<double>();
        points_of_label += s.points;
        red += s.red;
        green += s.green;
        blue += s.blue;
      }
      points += points_of_label;
      if (points_of_label > most) {  // labels come in ascending order, so that the smallest of equals stays
        most = points_of_label;
        majority = label_of_key(key);
      }
    }
    PointGroup& group = groups.emplace_back();
    group.voxel = voxel_of_key(voxel << kLabelBits) + grid_.origin;
    group.mean = (sum * (config_.voxel_m / weight)).cast<float>();
    group.weight = static_cast<float>(weight);
    const auto mean = [&](std::uint64_t total) { return static_cast<std::uint8_t>((total + points / 2) / points); };
    group.colour = {mean(red), mean(green), mean(blue)};
    group.label = majority;
    group.points = static_cast<std::uint32_t>(points);
  }
  return groups;
}

}  // namespace

std::vector<PointGroup> group_points(const RgbdFrame& frame, const Intrinsics& intrinsics, const std::vector<std::int32_t>& labels,
                                     const Pose& X_WC, const TsdfConfig& config) {
  const Grouping grouping(frame, intrinsics, labels, X_WC, config);
  const auto height = static_cast<std::size_t>(intrinsics.height);
  std::vector<std::vector<Sums>> bands((height + kBandRows - 1) / kBandRows);
  parallel_for(height, kBandRows, [&](std::size_t begin, std::size_t end) { bands[begin / kBandRows] = grouping.band(begin, end); });
  return grouping.merge(bands);
}

}  // namespace waretwin
