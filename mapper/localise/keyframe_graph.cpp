#include "mapper/localise/keyframe_graph.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

#include "core/error.h"
#include "core/pose.h"

namespace waretwin {
namespace {

struct Way {
  double cost;
  int keyframe;
  bool operator>(const Way& other) const { return cost != other.cost ? cost > other.cost : keyframe > other.keyframe; }
};

using Queue = std::priority_queue<Way, std::vector<Way>, std::greater<>>;

}  // namespace

Eigen::Matrix3d turned_covariance(const Eigen::Matrix3d& covariance, double yaw) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T.topLeftCorner<2, 2>() = PlanarMotion{{0, 0}, yaw}.rotation();
  return T * covariance * T.transpose();
}

Eigen::Matrix3d carried_covariance(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T(0, 2) = -(to.y() - from.y());
  T(1, 2) = to.x() - from.x();
  return T * covariance * T.transpose();
}

int KeyframeGraph::add(Keyframe keyframe) {
  keyframes_.push_back(std::move(keyframe));
  return static_cast<int>(keyframes_.size()) - 1;
}

std::vector<double> KeyframeGraph::paths_from(int keyframe) const {
  std::vector<std::vector<std::pair<int, double>>> neighbours(keyframes_.size());
  for (const KeyframeLink& link : links_) {
    const double length = link.X_ab.translation.norm();
    neighbours[static_cast<std::size_t>(link.a)].emplace_back(link.b, length);
    neighbours[static_cast<std::size_t>(link.b)].emplace_back(link.a, length);
  }
  std::vector<double> lengths(keyframes_.size(), std::numeric_limits<double>::infinity());
  lengths[static_cast<std::size_t>(keyframe)] = 0.0;
  Queue open;
  open.push({0.0, keyframe});
  while (!open.empty()) {
    const Way way = open.top();
    open.pop();
    if (way.cost > lengths[static_cast<std::size_t>(way.keyframe)]) continue;
    for (const auto& [next, length] : neighbours[static_cast<std::size_t>(way.keyframe)]) {
      double& known = lengths[static_cast<std::size_t>(next)];
      if (way.cost + length >= known) continue;
      known = way.cost + length;
      open.push({known, next});
    }
  }
  return lengths;
}

void KeyframeGraph::straighten() {
  const int unknowns = 3 * (static_cast<int>(keyframes_.size()) - 1);
  if (unknowns <= 0) return;
  constexpr int kMostSteps = 20;
  for (int round = 0; round < kMostSteps; ++round) {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd g = Eigen::VectorXd::Zero(unknowns);
    for (const KeyframeLink& link : links_) {
      const PlanarMotion& A = keyframes_[static_cast<std::size_t>(link.a)].X_SK;
      const PlanarMotion& B = keyframes_[static_cast<std::size_t>(link.b)].X_SK;
      const Eigen::Matrix2d R_AS = A.rotation().transpose();
      const Eigen::Vector2d t_AB = R_AS * (B.translation - A.translation);
      Eigen::Vector3d e;
      e << t_AB - link.X_ab.translation, wrap_angle(B.yaw - A.yaw - link.X_ab.yaw);
      Eigen::Matrix3d Ja = Eigen::Matrix3d::Zero(), Jb = Eigen::Matrix3d::Identity();
      Ja.topLeftCorner<2, 2>() = -R_AS;
      Ja(0, 2) = t_AB.y();
      Ja(1, 2) = -t_AB.x();
      Ja(2, 2) = -1.0;
      Jb.topLeftCorner<2, 2>() = R_AS;
      Eigen::Matrix3d information = link.covariance.inverse();
      if (link.loop) {
        constexpr double kScale = 9.0;  // squared: three standard deviations
        information *= 1.0 / (1.0 + e.dot(link.expected.inverse() * e) / kScale);
      }
      const std::array<std::pair<int, const Eigen::Matrix3d*>, 2> sides = {{{link.a, &Ja}, {link.b, &Jb}}};
      for (const auto& [i, Ji] : sides) {
        if (i == 0) continue;
        g.segment<3>(3 * (i - 1)) += Ji->transpose() * information * e;
        for (const auto& [j, Jj] : sides) {
          if (j == 0) continue;
          const Eigen::Matrix3d block = Ji->transpose() * information * *Jj;
          for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) entries.emplace_back(3 * (i - 1) + row, 3 * (j - 1) + column, block(row, column));
          }
        }
      }
    }
    // Keeps what no link holds where it is.
    for (int i = 0; i < unknowns; ++i) entries.emplace_back(i, i, 1e-6);
    Eigen::SparseMatrix<double> H(unknowns, unknowns);
    H.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(H);
    WARETWIN_CHECK(factors.info() == Eigen::Success, "the graph's equations can be solved");
    const Eigen::VectorXd step = -factors.solve(g);
    for (std::size_t k = 1; k < keyframes_.size(); ++k) {
      PlanarMotion& X = keyframes_[k].X_SK;
      X.translation += step.segment<2>(3 * (static_cast<Eigen::Index>(k) - 1));
      X.yaw = wrap_angle(X.yaw + step[3 * (static_cast<Eigen::Index>(k) - 1) + 2]);
    }
    if (step.cwiseAbs().maxCoeff() < 1e-7) break;
  }
  carry_covariances();
}

void KeyframeGraph::carry_covariances() {
  std::vector<std::vector<const KeyframeLink*>> links_at(keyframes_.size());
  for (const KeyframeLink& link : links_) {
    links_at[static_cast<std::size_t>(link.a)].push_back(&link);
    links_at[static_cast<std::size_t>(link.b)].push_back(&link);
  }
  std::vector<double> best(keyframes_.size(), std::numeric_limits<double>::infinity());
  std::vector<char> settled(keyframes_.size(), 0);
  const auto size_of = [](const Eigen::Matrix3d& c) { return c(0, 0) + c(1, 1) + c(2, 2); };
  best[0] = size_of(keyframes_[0].covariance);
  Queue open;
  open.push({best[0], 0});
  while (!open.empty()) {
    const int i = open.top().keyframe;
    open.pop();
    if (settled[static_cast<std::size_t>(i)] != 0) continue;
    settled[static_cast<std::size_t>(i)] = 1;
    const Keyframe& here = keyframes_[static_cast<std::size_t>(i)];
    for (const KeyframeLink* link : links_at[static_cast<std::size_t>(i)]) {
      const int j = link->a == i ? link->b : link->a;
      if (settled[static_cast<std::size_t>(j)] != 0) continue;
      Keyframe& there = keyframes_[static_cast<std::size_t>(j)];
      // A link that is walked backwards ends at a, where its own heading error acts through the arm.
      Eigen::Matrix3d own = turned_covariance(link->covariance, keyframes_[static_cast<std::size_t>(link->a)].X_SK.yaw);
      if (link->b == i) own = carried_covariance(own, here.X_SK.translation, there.X_SK.translation);
      const Eigen::Matrix3d covariance = carried_covariance(here.covariance, here.X_SK.translation, there.X_SK.translation) + own;
      if (size_of(covariance) >= best[static_cast<std::size_t>(j)]) continue;
      best[static_cast<std::size_t>(j)] = size_of(covariance);
      there.covariance = covariance;
      open.push({best[static_cast<std::size_t>(j)], j});
    }
  }
}

void KeyframeGraph::relink() {
  for (KeyframeLink& link : links_) {
    link.X_ab = keyframes_[static_cast<std::size_t>(link.a)].X_SK.inverse() * keyframes_[static_cast<std::size_t>(link.b)].X_SK;
  }
}

}  // namespace waretwin
