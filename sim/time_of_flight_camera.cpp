#include "sim/time_of_flight_camera.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <span>

#include "core/parallel.h"
#include "sensors/depth_field.h"
#include "sim/direct_light.h"
#include "sim/infrared.h"

namespace waretwin {

namespace {

constexpr double kSpeedOfLight = 299792458.0;  // m/s
constexpr int kMiddle = kTimeOfFlightPulses / 2;
constexpr std::size_t kRowsAtOnce = 8;

// Which ninth of the pixel each pulse looks through; neither coordinate goes with the time.
struct Ninth {
  int x, y;
};
constexpr std::array<Ninth, kTimeOfFlightPulses> kNinths = {{{-1, -1}, {1, 1}, {-1, 1}, {1, 0}, {0, 0}, {1, -1}, {0, -1}, {-1, 0}, {0, 1}}};

// A surface goes on from one pixel to the next if its plane predicts the neighbour's range to this share.
constexpr float kBend = 0.004f;

// Multipath: cells of the grid, rays of each cell, how far they look. Light from farther away is spread thin and out of step.
constexpr int kCell = 4, kMiddleOfCell = kCell / 2, kBounces = 6;
constexpr float kBounceReach = 1.5f;
constexpr float kMostIndirect = 4.0f;  // times the direct light

struct Look {                                           // at a pixel's centre
  float range = 0.0f;                                   // along the ray; 0 = nothing
  float length = 1.0f;                                  // of the ray whose z is 1
  Eigen::Vector3f direction = Eigen::Vector3f::Zero();  // unit, world
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();     // of the face, unit, towards the camera
  InfraredAnswer answer;
  int instance = -1, primitive = -1;
};

struct Cell {
  bool valid = false;
  Eigen::Vector3f position;  // from the camera, along the world's axes
  Eigen::Vector3f normal;
  std::complex<float> phasor;  // of the indirect light, relative to the direct
  float length = 0.0f;         // sum of the lengths that went into it
};

// Whether the plane of `a` goes through what `b` saw.
bool continues(const Look& a, const Look& b) {
  const float along = a.normal.dot(b.direction);
  if (!(along < -1e-3f)) return false;
  const float expected = a.range * a.normal.dot(a.direction) / along;
  return std::abs(expected - b.range) <= kBend * b.range;
}

bool smooth_between(const Look& a, const Look& b) {
  if (a.range == 0.0f || b.range == 0.0f) return a.range == b.range;
  // The same triangle is flat by itself; otherwise one plane that goes on is enough for two triangles of a round surface.
  return (a.instance == b.instance && a.primitive == b.primitive) || (continues(a, b) && continues(b, a));
}

// The i-th of a cell's directions about a normal, cosine-weighted. Any 3 x 3 cells together hold 9 * kBounces well spread directions
// (points of a rank-1 sequence; M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
Eigen::Vector3f bounce_direction(const Eigen::Vector3f& normal, int cell_x, int cell_y, int i) {
  const auto k = static_cast<std::uint32_t>(cell_x % 3 + 3 * (cell_y % 3) + 9 * i + 1);
  const auto unit = [](std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; };
  const float square = unit(k * 3242174889u), around = unit(k * 2447445414u);
  Eigen::Vector3f a, b;
  make_basis(normal, a, b);
  const Eigen::Vector2f turn = circle(around);
  const float radius = std::sqrt(square);
  return radius * turn.x() * a + radius * turn.y() * b + std::sqrt(std::max(0.0f, 1.0f - square)) * normal;
}

}  // namespace

struct TimeOfFlightCamera::State {
  std::shared_ptr<const RayCaster> ray_caster;
  const Surfaces& surfaces;
  CameraConfig camera;
  cv::Mat rays;
  float spread;           // angle of a pixel in the middle, radians
  float phase_per_metre;  // 4 pi f / c

  // Of the picture being made.
  PulseTimes times{};
  std::vector<Look> looks;
  std::vector<Cell> cells, smooth_cells;
  cv::Mat bends;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.cols) + static_cast<std::size_t>(x);
  }
  Look seen(const Ray& ray, const Hit& hit) const;
  void look_at_centres(const Pose& X_WD);
  void find_bends(const PulsePoses& X_WD);
  int pixels_moved(const PulsePoses& X_WD) const;
  void sum_pulses(const PulsePoses& X_WD, TimeOfFlightSignal& signal) const;
  void find_indirect(const Pose& X_WD);
  void smooth_indirect();
  void add_indirect(TimeOfFlightSignal& signal) const;
};

// `ray` has a unit direction.
Look TimeOfFlightCamera::State::seen(const Ray& ray, const Hit& hit) const {
  Look look;
  look.direction = ray.direction;
  if (!hit.valid()) return look;
  const SurfacePoint point = surfaces.at(ray, hit, spread);
  look.range = hit.distance;
  look.normal = point.face_normal;
  look.answer = infrared_answer(surfaces.material(hit), point, -ray.direction);
  look.instance = hit.instance;
  look.primitive = hit.primitive;
  return look;
}

void TimeOfFlightCamera::State::look_at_centres(const Pose& X_WD) {
  looks.resize(rays.total());
  const Eigen::Vector3f origin = X_WD.translation().cast<float>();
  const Eigen::Matrix3f R = X_WD.linear().cast<float>();
  parallel_for(static_cast<std::size_t>(rays.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> batch;
    std::vector<Hit> hits;
    std::vector<std::size_t> pixels;
    // Packets of four by two pixels.
    for (std::size_t top = begin; top < end; top += 2) {
      batch.clear();
      pixels.clear();
      for (int left = 0; left < rays.cols; left += 4) {
        for (int y = static_cast<int>(top); y < static_cast<int>(std::min(top + 2, end)); ++y) {
          for (int x = left; x < std::min(left + 4, rays.cols); ++x) {
            const std::size_t p = index(x, y);
            looks[p] = {};
            const cv::Vec3f& d = rays.at<cv::Vec3f>(y, x);
            if (d[2] == 0.0f) continue;
            const Eigen::Vector3f direction(d[0], d[1], d[2]);
            looks[p].length = direction.norm();
            Ray ray;
            ray.time = times[kMiddle];
            ray.origin = origin;
            ray.direction = R * (direction / looks[p].length);
            batch.push_back(ray);
            pixels.push_back(p);
          }
        }
      }
      hits.resize(batch.size());
      ray_caster->cast(batch, hits, Coherence::kCoherent);
      for (std::size_t i = 0; i < batch.size(); ++i) {
        const float length = looks[pixels[i]].length;
        looks[pixels[i]] = seen(batch[i], hits[i]);
        looks[pixels[i]].length = length;
      }
    }
  });
}

// How far the picture moves between the first and the middle pulse, in pixels.
int TimeOfFlightCamera::State::pixels_moved(const PulsePoses& X_WD) const {
  double farthest = 0.0;
  for (const Pose* X : {&X_WD.front(), &X_WD.back()}) {
    const Pose moved = X_WD[kMiddle].inverse() * *X;
    const double angle = Eigen::AngleAxisd(moved.linear()).angle();
    farthest = std::max(farthest, angle + moved.translation().norm() / camera.depth_min_m);
  }
  // Less than a twentieth of a pixel is standing still.
  const double pixels = farthest * camera.time_of_flight.focal_px;
  return pixels < 0.05 ? 0 : static_cast<int>(std::ceil(std::min(pixels, 32.0)));
}

void TimeOfFlightCamera::State::find_bends(const PulsePoses& X_WD) {
  bends.create(rays.size(), CV_8UC1);
  const bool pulses_differ = camera.time_of_flight.motion && pixels_moved(X_WD) > 0;
  bends.setTo(0);
  if (!camera.time_of_flight.mixed_pixels && !pulses_differ) return;
  parallel_for(static_cast<std::size_t>(rays.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      auto* row = bends.ptr<std::uint8_t>(y);
      for (int x = 0; x < rays.cols; ++x) {
        const Look& here = looks[index(x, y)];
        const auto breaks = [&](int other_x, int other_y) {
          if (other_x < 0 || other_y < 0 || other_x >= rays.cols || other_y >= rays.rows) return false;
          return !smooth_between(here, looks[index(other_x, other_y)]);
        };
        row[x] = breaks(x - 1, y) || breaks(x + 1, y) || breaks(x, y - 1) || breaks(x, y + 1) ? 1 : 0;
      }
    }
  });
  // Where nothing goes on, neighbours over the corner are near enough; motion brings in what is farther away.
  const int radius = camera.time_of_flight.motion ? pixels_moved(X_WD) : 0;
  if (radius > 0) cv::dilate(bends, bends, cv::Mat::ones(2 * radius + 1, 2 * radius + 1, CV_8UC1));
}

void TimeOfFlightCamera::State::sum_pulses(const PulsePoses& X_WD, TimeOfFlightSignal& signal) const {
  const TimeOfFlightConfig& config = camera.time_of_flight;
  const auto light = static_cast<float>(config.illumination);
  std::array<Eigen::Vector3f, kTimeOfFlightPulses> origins;
  std::array<Eigen::Matrix3f, kTimeOfFlightPulses> rotations;
  for (std::size_t k = 0; k < kTimeOfFlightPulses; ++k) {
    const Pose& X = config.motion ? X_WD[k] : X_WD[kMiddle];
    origins[k] = X.translation().cast<float>();
    rotations[k] = X.linear().cast<float>();
  }
  parallel_for(static_cast<std::size_t>(rays.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> batch;
    std::vector<Hit> hits;
    std::vector<int> columns;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      auto* range = signal.range.ptr<float>(y);
      auto* strength = signal.signal.ptr<float>(y);
      auto* coherence = signal.coherence.ptr<float>(y);
      const auto* bend = bends.ptr<std::uint8_t>(y);
      const auto* ray_row = rays.ptr<cv::Vec3f>(y);
      batch.clear();
      columns.clear();
      for (int x = 0; x < rays.cols; ++x) {
        const Look& look = looks[index(x, y)];
        range[x] = look.range;
        strength[x] = look.range > 0.0f ? light * look.answer.backscatter / (look.range * look.range) : 0.0f;
        coherence[x] = 1.0f;
        if (!bend[x] || ray_row[x][2] == 0.0f) continue;
        columns.push_back(x);
        const Eigen::Vector3f centre(ray_row[x][0], ray_row[x][1], 1.0f);
        // From pixel to pixel the ray changes evenly enough for thirds of a pixel.
        const auto slope = [&](const cv::Vec3f* before, const cv::Vec3f* after) -> Eigen::Vector3f {
          const cv::Vec3f& here = ray_row[x];
          if (after != nullptr && (*after)[2] != 0.0f) return {(*after)[0] - here[0], (*after)[1] - here[1], 0.0f};
          if (before != nullptr && (*before)[2] != 0.0f) return {here[0] - (*before)[0], here[1] - (*before)[1], 0.0f};
          return Eigen::Vector3f::Zero();
        };
        const Eigen::Vector3f right = slope(x > 0 ? &ray_row[x - 1] : nullptr, x + 1 < rays.cols ? &ray_row[x + 1] : nullptr);
        const Eigen::Vector3f down =
            slope(y > 0 ? &rays.ptr<cv::Vec3f>(y - 1)[x] : nullptr, y + 1 < rays.rows ? &rays.ptr<cv::Vec3f>(y + 1)[x] : nullptr);
        for (std::size_t k = 0; k < kTimeOfFlightPulses; ++k) {
          if (k == kMiddle) continue;  // has been looked at: its ninth is the middle one
          Eigen::Vector3f direction = centre;
          if (config.mixed_pixels) {
            direction += static_cast<float>(kNinths[k].x) / 3.0f * right + static_cast<float>(kNinths[k].y) / 3.0f * down;
          }
          Ray ray;
          ray.time = config.motion ? times[k] : times[kMiddle];
          ray.origin = origins[k];
          ray.direction = rotations[k] * direction.normalized();
          batch.push_back(ray);
        }
      }
      hits.resize(batch.size());
      ray_caster->cast(batch, hits, Coherence::kCoherent);
      constexpr std::size_t kOthers = kTimeOfFlightPulses - 1;
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const int x = columns[c];
        const Look& centre = looks[index(x, y)];
        std::array<float, kTimeOfFlightPulses> ranges{}, lengths{};
        ranges[kOthers] = centre.range;
        lengths[kOthers] = strength[x];
        Look last = centre;
        for (std::size_t i = 0; i < kOthers; ++i) {
          const Hit& hit = hits[c * kOthers + i];
          if (!hit.valid()) continue;
          // On one triangle the answer hardly changes within a pixel.
          if (hit.instance != last.instance || hit.primitive != last.primitive) last = seen(batch[c * kOthers + i], hit);
          ranges[i] = hit.distance;
          lengths[i] = light * last.answer.backscatter / (hit.distance * hit.distance);
        }
        // Phases are counted from the strongest echo, so that the sum's angle is a small one.
        const auto strongest = static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
        std::complex<float> sum = 0.0f;
        float total = 0.0f;
        for (std::size_t i = 0; i < kTimeOfFlightPulses; ++i) {
          if (!(lengths[i] > 0.0f)) continue;
          sum += std::polar(lengths[i], phase_per_metre * (ranges[i] - ranges[strongest]));
          total += lengths[i];
        }
        if (!(total > 0.0f)) {
          range[x] = strength[x] = 0.0f;
          continue;
        }
        range[x] = ranges[strongest] + std::arg(sum) / phase_per_metre;
        strength[x] = std::abs(sum) / static_cast<float>(kTimeOfFlightPulses);
        coherence[x] = std::min(std::abs(sum) / total, 1.0f);
      }
    }
  });
}

void TimeOfFlightCamera::State::find_indirect(const Pose& X_WD) {
  const int cell_columns = (rays.cols + kCell - 1) / kCell, cell_rows = (rays.rows + kCell - 1) / kCell;
  cells.assign(static_cast<std::size_t>(cell_columns) * static_cast<std::size_t>(cell_rows), {});
  const Eigen::Vector3f origin = X_WD.translation().cast<float>();
  const Eigen::Matrix3f R_DW = X_WD.linear().transpose().cast<float>();
  parallel_for(static_cast<std::size_t>(cell_rows), 2, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> bounces, to_light;
    std::vector<Hit> hits;
    std::vector<std::uint8_t> blocked;
    struct Bounce {
      Cell* cell;
      std::complex<float> phasor;
    };
    std::vector<Bounce> made;
    std::vector<std::pair<Cell*, const Look*>> of_cell;
    for (int cy = static_cast<int>(begin); cy < static_cast<int>(end); ++cy) {
      bounces.clear();
      of_cell.clear();
      for (int cx = 0; cx < cell_columns; ++cx) {
        const int x = std::min(cx * kCell + kMiddleOfCell, rays.cols - 1), y = std::min(cy * kCell + kMiddleOfCell, rays.rows - 1);
        const Look& look = looks[index(x, y)];
        if (look.range == 0.0f || !(look.answer.backscatter > 0.0f)) continue;
        Cell& cell = cells[static_cast<std::size_t>(cy) * static_cast<std::size_t>(cell_columns) + static_cast<std::size_t>(cx)];
        cell.valid = true;
        cell.position = look.range * look.direction;
        cell.normal = look.normal;
        of_cell.emplace_back(&cell, &look);
        for (int i = 0; i < kBounces; ++i) {
          Ray ray;
          ray.time = times[kMiddle];
          ray.origin = origin + cell.position + 1e-3f * cell.normal;
          ray.direction = bounce_direction(cell.normal, cx, cy, i);
          ray.far = kBounceReach;
          bounces.push_back(ray);
        }
      }
      hits.resize(bounces.size());
      ray_caster->cast(bounces, hits, Coherence::kIncoherent);
      made.clear();
      to_light.clear();
      for (std::size_t i = 0; i < bounces.size(); ++i) {
        if (!hits[i].valid()) continue;
        const auto& [cell, look] = of_cell[i / kBounces];
        const SurfacePoint other = surfaces.at(bounces[i], hits[i], 0.02f);
        const Eigen::Vector3f to_camera = origin - other.position;
        const float other_range = to_camera.norm();
        const float cosine = other.face_normal.dot(to_camera) / other_range;
        if (!(cosine > 0.0f)) continue;
        const Eigen::Vector3f seen_D = R_DW * -to_camera;
        if (!(seen_D.z() > 0.0f) || !inside_outline(camera.field, seen_D.x() / seen_D.z(), seen_D.y() / seen_D.z())) continue;
        const InfraredAnswer answer = infrared_answer(surfaces.material(hits[i]), other, to_camera / other_range);
        const float ratio = look->answer.albedo / look->answer.backscatter * answer.albedo * cosine * look->range * look->range /
                            (other_range * other_range * static_cast<float>(kBounces));
        const float longer = 0.5f * (other_range + hits[i].distance - look->range);
        made.push_back({cell, std::polar(std::min(ratio, kMostIndirect / kBounces), phase_per_metre * std::max(longer, 0.0f))});
        Ray ray;
        ray.time = times[kMiddle];
        ray.origin = other.position + 1e-3f * other.face_normal;
        ray.direction = origin - ray.origin;
        ray.far = 1.0f;
        to_light.push_back(ray);
      }
      blocked.resize(to_light.size());
      ray_caster->occluded(to_light, blocked, Coherence::kIncoherent);
      for (std::size_t i = 0; i < made.size(); ++i) {
        if (blocked[i]) continue;
        made[i].cell->phasor += made[i].phasor;
        made[i].cell->length += std::abs(made[i].phasor);
      }
    }
  });
}

namespace {

bool same_surface(const Eigen::Vector3f& position, const Eigen::Vector3f& normal, const Cell& cell, float range) {
  return cell.valid && cell.normal.dot(normal) > 0.95f && std::abs(normal.dot(cell.position - position)) < 0.02f * range;
}

}  // namespace

void TimeOfFlightCamera::State::smooth_indirect() {
  const int columns = (rays.cols + kCell - 1) / kCell, rows = (rays.rows + kCell - 1) / kCell;
  smooth_cells = cells;
  parallel_for(static_cast<std::size_t>(rows), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < columns; ++x) {
        const auto at = [columns](int cx, int cy) {
          return static_cast<std::size_t>(cy) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(cx);
        };
        Cell& out = smooth_cells[at(x, y)];
        if (!out.valid) continue;
        const Look& look =
            looks[index(std::min(x * kCell + kMiddleOfCell, rays.cols - 1), std::min(y * kCell + kMiddleOfCell, rays.rows - 1))];
        std::complex<float> phasor = 0.0f;
        float length = 0.0f, count = 0.0f;
        for (int cy = std::max(y - 1, 0); cy <= std::min(y + 1, rows - 1); ++cy) {
          for (int cx = std::max(x - 1, 0); cx <= std::min(x + 1, columns - 1); ++cx) {
            const Cell& other = cells[at(cx, cy)];
            if (!same_surface(out.position, out.normal, other, look.range)) continue;
            phasor += other.phasor;
            length += other.length;
            count += 1.0f;
          }
        }
        out.phasor = phasor / count;
        out.length = length / count;
      }
    }
  });
}

void TimeOfFlightCamera::State::add_indirect(TimeOfFlightSignal& signal) const {
  const int columns = (rays.cols + kCell - 1) / kCell, rows = (rays.rows + kCell - 1) / kCell;
  parallel_for(static_cast<std::size_t>(rays.rows), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      auto* range = signal.range.ptr<float>(y);
      auto* strength = signal.signal.ptr<float>(y);
      auto* indirect = signal.indirect.ptr<float>(y);
      const float fy = static_cast<float>(y - kMiddleOfCell) / kCell;
      const int y0 = std::clamp(static_cast<int>(std::floor(fy)), 0, rows - 1), y1 = std::min(y0 + 1, rows - 1);
      const float wy = std::clamp(fy - static_cast<float>(y0), 0.0f, 1.0f);
      for (int x = 0; x < rays.cols; ++x) {
        const Look& look = looks[index(x, y)];
        if (look.range == 0.0f || range[x] == 0.0f) continue;
        const float fx = static_cast<float>(x - kMiddleOfCell) / kCell;
        const int x0 = std::clamp(static_cast<int>(std::floor(fx)), 0, columns - 1), x1 = std::min(x0 + 1, columns - 1);
        const float wx = std::clamp(fx - static_cast<float>(x0), 0.0f, 1.0f);
        const Eigen::Vector3f position = look.range * look.direction;
        std::complex<float> phasor = 0.0f;
        float length = 0.0f, weights = 0.0f;
        const auto add = [&](int cx, int cy, float weight) {
          const Cell& cell = smooth_cells[static_cast<std::size_t>(cy) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(cx)];
          weight += 1e-4f;  // a cell at the far side still beats none
          if (!same_surface(position, look.normal, cell, look.range)) return;
          phasor += weight * cell.phasor;
          length += weight * cell.length;
          weights += weight;
        };
        add(x0, y0, (1.0f - wx) * (1.0f - wy));
        add(x1, y0, wx * (1.0f - wy));
        add(x0, y1, (1.0f - wx) * wy);
        add(x1, y1, wx * wy);
        if (weights == 0.0f || length == 0.0f) continue;
        const std::complex<float> sum = 1.0f + phasor / weights;
        range[x] += std::arg(sum) / phase_per_metre;
        strength[x] *= std::abs(sum);
        indirect[x] = length / weights;
      }
    }
  });
}

TimeOfFlightCamera::TimeOfFlightCamera(std::shared_ptr<const RayCaster> ray_caster, const Surfaces& surfaces, const CameraConfig& camera,
                                       const cv::Mat& rays)
    : state_(new State{
          .ray_caster = std::move(ray_caster),
          .surfaces = surfaces,
          .camera = camera,
          .rays = rays,
          .spread = static_cast<float>(1.0 / camera.time_of_flight.focal_px),
          .phase_per_metre = static_cast<float>(4.0 * std::numbers::pi * camera.time_of_flight.modulation_mhz * 1e6 / kSpeedOfLight),
          .looks = {},
          .cells = {},
          .smooth_cells = {},
          .bends = {}}) {}

TimeOfFlightCamera::~TimeOfFlightCamera() = default;
TimeOfFlightCamera::TimeOfFlightCamera(TimeOfFlightCamera&&) noexcept = default;

TimeOfFlightSignal TimeOfFlightCamera::look(const PulsePoses& X_WD) {
  PulseTimes middle;
  middle.fill(0.5f);
  return look(X_WD, middle);
}

TimeOfFlightSignal TimeOfFlightCamera::look(const PulsePoses& X_WD, const PulseTimes& times) {
  State& s = *state_;
  s.times = times;
  TimeOfFlightSignal signal;
  for (cv::Mat* image : {&signal.range, &signal.signal, &signal.coherence, &signal.indirect}) image->create(s.rays.size(), CV_32FC1);
  signal.indirect.setTo(0);
  s.look_at_centres(X_WD[kMiddle]);
  s.find_bends(X_WD);
  s.sum_pulses(X_WD, signal);
  if (s.camera.time_of_flight.multipath) {
    s.find_indirect(X_WD[kMiddle]);
    s.smooth_indirect();
    s.add_indirect(signal);
  }
  return signal;
}

}  // namespace waretwin
