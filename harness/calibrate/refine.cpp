#include "harness/calibrate/refine.h"

#include "core/error.h"

#ifdef WARETWIN_CERES
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/statistics.h"
#endif

namespace waretwin {

void RefineConfig::visit(Fields& f) {
  f("range_bias_m", range_bias_m, "all ranges may be off alike by about this much (one sigma), which is estimated, too; 0: they are not",
    {.min = 0, .max = 1});
  f("loss_scale", loss_scale, "Huber loss: residuals beyond this many sigmas count less", {.min = 0.1, .max = 1000});
}

#ifndef WARETWIN_CERES

void expect_refinement() { throw Error("calibrate: this program was built without Ceres; install libceres-dev and build again"); }

Refined refine(const std::vector<BoardView>&, const Intrinsics&, const CheckerBoard&, const Pose&, const Pose&, double,
               const RefineConfig&) {
  expect_refinement();
  return {};
}

#else

void expect_refinement() {}

namespace {

// A small motion about a pose: shift and turn, X = (p + shift, exp(turn) R).
template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
using Step = std::array<double, 6>;

template <class T>
Vector3<T> turned(const T* step, const Vector3<T>& v) {
  Vector3<T> out;
  ceres::AngleAxisRotatePoint(step + 3, v.data(), out.data());
  return out;
}

template <class T>
Vector3<T> shift(const T* step) {
  return {step[0], step[1], step[2]};
}

Pose moved(const Pose& X, const Step& step) {
  Pose out = X;
  const Eigen::Vector3d turn(step[3], step[4], step[5]);
  if (turn.norm() > 0.0) out.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * X.linear();
  out.translation() += Eigen::Vector3d(step[0], step[1], step[2]);
  return orthonormalised(out);
}

// All corners of a view, in pixels over sigma.
struct CornerCost {
  const BoardView* view;
  const Pose* X_CO;
  const std::vector<Eigen::Vector3d>* corners_O;
  Intrinsics k;
  double sigma_px;

  template <class T>
  bool operator()(const T* board, T* residuals) const {
    for (std::size_t i = 0; i < corners_O->size(); ++i) {
      const Vector3<T> at = (X_CO->linear() * (*corners_O)[i]).template cast<T>();
      const Vector3<T> p = turned(board, at) + X_CO->translation().template cast<T>() + shift(board);
      if (p.z() <= T(0.0)) return false;
      residuals[2 * i] = (k.fx * p.x() / p.z() + k.cx - view->corners[i].x()) / sigma_px;
      residuals[2 * i + 1] = (k.fy * p.y() / p.z() + k.cy - view->corners[i].y()) / sigma_px;
    }
    return true;
  }
};

// A beam's mean range less the bias against the way to the board, in metres over sigma.
struct BeamCost {
  const LaserPoint* point;
  const Pose *X_CO, *X_BC, *X_BL;
  double sigma_m;

  template <class T>
  bool operator()(const T* camera, const T* bias, const T* board, T* residual) const {
    const Vector3<T> normal_C = turned<T>(board, X_CO->linear().col(2).template cast<T>());
    const Vector3<T> middle_C = X_CO->translation().template cast<T>() + shift(board);
    // The board in B; the beam is known there.
    const auto in_B = [&](const Vector3<T>& v) { return turned<T>(camera, X_BC->linear().template cast<T>() * v); };
    const Vector3<T> normal_B = in_B(normal_C);
    const Vector3<T> middle_B = in_B(middle_C) + X_BC->translation().template cast<T>() + shift(camera);
    const Vector3<T> ray_B = (X_BL->linear() * point->direction_L()).template cast<T>();
    const T slant = normal_B.dot(ray_B);
    if (ceres::abs(slant) < T(1e-3)) return false;
    const T range = normal_B.dot(middle_B - X_BL->translation().template cast<T>()) / slant;
    residual[0] = (T(point->range_m) - bias[0] - range) / sigma_m;
    return true;
  }
};

// The bias as the data sheet has it.
struct BiasCost {
  double sigma_m;
  template <class T>
  bool operator()(const T* bias, T* residual) const {
    residual[0] = bias[0] / sigma_m;
    return true;
  }
};

struct Sigmas {
  double corner_px = 0.1, beam_factor = 1.0;
};
// What averages of many readings do not go below: the board is not flat, the spot not round.
constexpr double kLeastSigma_m = 0.0003;

double sigma_of(const LaserPoint& point, const Sigmas& sigmas) { return sigmas.beam_factor * std::hypot(point.sigma_m, kLeastSigma_m); }

class Problem {
 public:
  Problem(const std::vector<BoardView>& views, const Intrinsics& k, const CheckerBoard& board, const Pose& X_BL, const Refined& from,
          const RefineConfig& config, const Sigmas& sigmas)
      : views_(views), corners_O_(board.corners_O()), X_BL_(X_BL), from_(from), sigmas_(sigmas), bias_(from.bias_m), boards_(views.size()) {
    for (Step& step : boards_) step.fill(0.0);
    camera_.fill(0.0);
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].points.empty()) continue;
      const int coordinates = static_cast<int>(2 * corners_O_.size());
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<CornerCost, ceres::DYNAMIC, 6>(
                                    new CornerCost{&views[i], &from_.X_CO[i], &corners_O_, k, sigmas.corner_px}, coordinates),
                                nullptr, boards_[i].data());
      for (const LaserPoint& point : views[i].points) {
        problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<BeamCost, 1, 6, 1, 6>(
                                      new BeamCost{&point, &from_.X_CO[i], &from_.X_BC, &X_BL_, sigma_of(point, sigmas)}),
                                  new ceres::HuberLoss(config.loss_scale), camera_.data(), &bias_, boards_[i].data());
      }
    }
    estimates_bias_ = config.range_bias_m > 0.0;
    if (estimates_bias_) {
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<BiasCost, 1, 1>(new BiasCost{config.range_bias_m}), nullptr, &bias_);
    } else {
      problem_.SetParameterBlockConstant(&bias_);
    }
  }

  Refined solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_SCHUR;  // boards meet in the camera alone
    options.num_threads = 1;                          // same input, same bytes
    options.max_num_iterations = 100;
    options.function_tolerance = 1e-14;
    options.parameter_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    if (!summary.IsSolutionUsable())
      throw Error("the calibration found no minimum; expected more board poses, turned and tilted differently");
    Refined found = from_;
    found.X_BC = moved(from_.X_BC, camera_);
    found.bias_m = bias_;
    for (std::size_t i = 0; i < views_.size(); ++i) found.X_CO[i] = moved(from_.X_CO[i], boards_[i]);
    measure(found);
    return found;
  }

  // At the parameters as they are.
  Eigen::Matrix<double, 7, 7> covariance() {
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::SPARSE_QR;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    options.num_threads = 1;
    ceres::Covariance estimate(options);
    std::vector<std::pair<const double*, const double*>> blocks = {{camera_.data(), camera_.data()}};
    if (estimates_bias_) {
      blocks.emplace_back(camera_.data(), &bias_);
      blocks.emplace_back(&bias_, &bias_);
    }
    if (!estimate.Compute(blocks, &problem_)) {
      throw Error(
          "the motion of the board is degenerate: the boards' poses leave the camera's mounting open; expected more of them, turned and "
          "tilted differently");
    }
    Eigen::Matrix<double, 7, 7> all = Eigen::Matrix<double, 7, 7>::Zero();
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> camera;
    estimate.GetCovarianceBlock(camera_.data(), camera_.data(), camera.data());
    all.topLeftCorner<6, 6>() = camera;
    if (estimates_bias_) {
      Eigen::Matrix<double, 6, 1> mixed;
      estimate.GetCovarianceBlock(camera_.data(), &bias_, mixed.data());
      all.topRightCorner<6, 1>() = mixed;
      all.bottomLeftCorner<1, 6>() = mixed.transpose();
      estimate.GetCovarianceBlock(&bias_, &bias_, &all(6, 6));
    }
    return all;
  }

 private:
  // What the residuals say of the sigmas.
  void measure(Refined& found) {
    ceres::Problem::EvaluateOptions options;
    options.apply_loss_function = false;
    std::vector<double> residuals;
    problem_.Evaluate(options, nullptr, &residuals, nullptr, nullptr);
    double corners = 0.0, squares = 0.0;
    int boards = 0;
    std::vector<double> beams;
    std::size_t at = 0;
    for (const BoardView& view : views_) {
      if (view.points.empty()) continue;
      ++boards;
      for (std::size_t i = 0; i < 2 * corners_O_.size(); ++i, ++at) corners += residuals[at] * residuals[at];
      for (const LaserPoint& point : view.points) {
        const double over_sigma = residuals[at++];
        beams.push_back(std::abs(over_sigma));
        squares += std::pow(over_sigma * sigma_of(point, sigmas_), 2);
      }
    }
    found.points = static_cast<int>(beams.size());
    // Six numbers of each board follow its corners, seven more the beams.
    const double free = static_cast<double>(boards) * (2.0 * static_cast<double>(corners_O_.size()) - 6.0);
    found.corner_sigma_px = sigmas_.corner_px * std::sqrt(corners / std::max(1.0, free));
    // Of a normal distribution: from the median of the absolute values to sigma.
    constexpr double kNormal = 1.4826;
    found.beam_factor = sigmas_.beam_factor * (beams.empty() ? 1.0 : kNormal * median(beams));
    found.beam_factor *= std::sqrt(found.points / std::max(1.0, found.points - 7.0));
    found.rms_m = std::sqrt(squares / std::max(1, found.points));
  }

  const std::vector<BoardView>& views_;
  std::vector<Eigen::Vector3d> corners_O_;
  Pose X_BL_;
  Refined from_;
  Sigmas sigmas_;
  double bias_;
  Step camera_;
  std::vector<Step> boards_;
  bool estimates_bias_ = false;
  ceres::Problem problem_;
};

}  // namespace

Refined refine(const std::vector<BoardView>& views, const Intrinsics& intrinsics, const CheckerBoard& board, const Pose& X_BL,
               const Pose& X_BC_start, double bias_start_m, const RefineConfig& config) {
  Refined found;
  found.X_BC = X_BC_start;
  found.bias_m = config.range_bias_m > 0.0 ? bias_start_m : 0.0;
  int seen = 0;
  double squares = 0.0;
  for (const BoardView& view : views) {
    found.X_CO.push_back(view.X_CO);
    if (view.points.empty()) continue;
    ++seen;
    squares += view.rms_px * view.rms_px / 2.0;
  }
  if (seen == 0) throw Error("the laser met no board; expected boards that camera and laser both see");
  // Exact corners (of a test, say) must not become weights without bound.
  constexpr double kLeastPx = 1e-6, kLeastFactor = 1e-6;
  Sigmas sigmas{.corner_px = std::max(kLeastPx, std::sqrt(squares / seen))};
  // The sigmas settle in few rounds, each of which begins where the last one ended.
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    Problem problem(views, intrinsics, board, X_BL, found, config, sigmas);
    found = problem.solve();
    sigmas = {std::max(kLeastPx, found.corner_sigma_px), std::max(kLeastFactor, found.beam_factor)};
  }
  Problem last(views, intrinsics, board, X_BL, found, config, sigmas);
  found.covariance = last.covariance();
  return found;
}

#endif

}  // namespace waretwin
