#include "tests/bench/open3d_peer.h"

#include <open3d/core/Tensor.h>
#include <open3d/t/geometry/Image.h>
#include <open3d/t/geometry/VoxelBlockGrid.h>

#include <cstring>
#include <vector>

namespace waretwin::bench {

using open3d::core::Tensor;

struct Open3dPeer::State {
  open3d::t::geometry::VoxelBlockGrid grid;
  Tensor intrinsic, extrinsic;
  open3d::t::geometry::Image depth, colour;
};

Open3dPeer::Open3dPeer(const Intrinsics& intrinsics) : state_(std::make_unique<State>()) {
  namespace core = open3d::core;
  state_->grid = open3d::t::geometry::VoxelBlockGrid({"tsdf", "weight", "color"}, {core::Float32, core::UInt16, core::UInt16},
                                                     {{1}, {1}, {3}}, 0.02f, 16, 10000);
  state_->intrinsic = Tensor::Init<double>({{intrinsics.fx, 0.0, intrinsics.cx}, {0.0, intrinsics.fy, intrinsics.cy}, {0.0, 0.0, 1.0}});
}

Open3dPeer::~Open3dPeer() = default;

void Open3dPeer::prepare(const RgbdFrame& frame, const Pose& X_WC) {
  const cv::Mat millimetres = depth_to_millimetres(frame.depth);
  const int rows = frame.depth.rows, columns = frame.depth.cols;
  const auto pixels = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  std::vector<std::uint16_t> depth(millimetres.ptr<std::uint16_t>(0), millimetres.ptr<std::uint16_t>(0) + pixels);
  std::vector<std::uint8_t> colour(3 * pixels);
  const std::uint8_t* const bgr = frame.colour.ptr<std::uint8_t>(0);
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) colour[3 * i + k] = bgr[3 * i + 2 - k];
  }
  state_->depth = open3d::t::geometry::Image(Tensor(depth, {rows, columns, 1}, open3d::core::UInt16));
  state_->colour = open3d::t::geometry::Image(Tensor(colour, {rows, columns, 3}, open3d::core::UInt8));
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> X_CW = X_WC.inverse().matrix();
  state_->extrinsic = Tensor(std::vector<double>(X_CW.data(), X_CW.data() + 16), {4, 4}, open3d::core::Float64);
}

void Open3dPeer::integrate() {
  constexpr float kScale = 1000.0f, kFarthest = 5.0f, kTruncationVoxels = 4.0f;
  State& s = *state_;
  const Tensor blocks = s.grid.GetUniqueBlockCoordinates(s.depth, s.intrinsic, s.extrinsic, kScale, kFarthest, kTruncationVoxels);
  s.grid.Integrate(blocks, s.depth, s.colour, s.intrinsic, s.extrinsic, kScale, kFarthest, kTruncationVoxels);
}

}  // namespace waretwin::bench
