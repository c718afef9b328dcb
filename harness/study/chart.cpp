#include "harness/study/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace waretwin {

namespace {

const cv::Scalar kPaper(255, 255, 255), kInk(50, 50, 50), kGrid(230, 230, 230);
constexpr double kScale = 0.45;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr int kLeft = 80, kRight = 24, kTop = 56, kBottom = 62;
constexpr int kFine = 4;  // bits of a pixel, for drawing between pixels

cv::Point fine(const cv::Point2d& p) {
  return {static_cast<int>(std::lround(p.x * (1 << kFine))), static_cast<int>(std::lround(p.y * (1 << kFine)))};
}

int width_of(const std::string& text, double scale = kScale) {
  int base = 0;
  return cv::getTextSize(text, kFont, scale, 1, &base).width;
}

void write(cv::Mat& image, const cv::Point& at, const std::string& text, const cv::Scalar& colour, double scale = kScale) {
  cv::putText(image, text, at, kFont, scale, colour, 1, cv::LINE_AA);
}

std::string tick_text(double value, double step) {
  char text[32];
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  std::snprintf(text, sizeof text, "%.*f", digits, value + 0.0);
  return text;
}

// Room around the data, and for data without extent.
ChartAxis widened(ChartAxis axis) {
  if (!axis.levels.empty()) {
    axis.low = -0.5;
    axis.high = static_cast<double>(axis.levels.size()) - 0.5;
    return axis;
  }
  const double extent = axis.high - axis.low;
  const double margin = extent > 0.0 ? 0.06 * extent : std::max(1e-3, 0.1 * std::abs(axis.low));
  axis.low -= margin;
  axis.high += margin;
  return axis;
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  if (!(high > low) || count < 1) return {low};
  const double raw = (high - low) / count, magnitude = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * magnitude;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * magnitude >= raw * (1.0 - 1e-9)) {
      step = factor * magnitude;
      break;
    }
  }
  std::vector<double> ticks;
  const auto first = static_cast<long long>(std::ceil(low / step - 1e-9)), last = static_cast<long long>(std::floor(high / step + 1e-9));
  for (long long k = first; k <= last; ++k) ticks.push_back(static_cast<double>(k) * step);
  return ticks;
}

cv::Scalar ramp_colour(double share) {
  constexpr std::array<std::array<double, 3>, 5> kStops = {
      {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};  // red, green, blue
  const double at = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double t = at - static_cast<double>(i);
  std::array<double, 3> c{};
  for (std::size_t k = 0; k < 3; ++k) c[k] = (1 - t) * kStops[i][k] + t * kStops[i + 1][k];
  return {c[2], c[1], c[0]};
}

Chart::Chart(int width, int height, const std::string& title, const ChartAxis& x, const ChartAxis& y)
    : image_(height, width, CV_8UC3, kPaper),
      plot_(kLeft, kTop, width - kLeft - kRight, height - kTop - kBottom),
      x_(widened(x)),
      y_(widened(y)) {
  write(image_, {kLeft, 24}, title, kInk, 0.6);
  draw_axis(x_, false);
  draw_axis(y_, true);
}

cv::Point2d Chart::at(double x, double y) const {
  return {plot_.x + plot_.width * (x - x_.low) / (x_.high - x_.low), plot_.y + plot_.height * (1.0 - (y - y_.low) / (y_.high - y_.low))};
}

void Chart::draw_axis(const ChartAxis& axis, bool vertical) {
  const std::vector<double> ticks = axis.levels.empty() ? round_ticks(axis.low, axis.high, vertical ? 6 : 8) : [&] {
    std::vector<double> all;
    for (std::size_t k = 0; k < axis.levels.size(); ++k) all.push_back(static_cast<double>(k));
    return all;
  }();
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  // Names that are wider than their places stand in two rows by turns.
  const double place = vertical ? 0.0 : plot_.width * step / (axis.high - axis.low);
  const bool crowded =
      std::any_of(axis.levels.begin(), axis.levels.end(), [&](const std::string& level) { return width_of(level) > place - 6; });
  for (std::size_t k = 0; k < ticks.size(); ++k) {
    const std::string text = axis.levels.empty() ? tick_text(ticks[k], step) : axis.levels[k];
    if (vertical) {
      const int y = static_cast<int>(std::lround(at(x_.low, ticks[k]).y));
      cv::line(image_, {kLeft, y}, {image_.cols - kRight, y}, kGrid, 1);
      write(image_, {kLeft - 8 - width_of(text), y + 5}, text, kInk);
    } else {
      const int x = static_cast<int>(std::lround(at(ticks[k], y_.low).x));
      cv::line(image_, {x, kTop}, {x, image_.rows - kBottom}, kGrid, 1);
      write(image_, {x - width_of(text) / 2, image_.rows - kBottom + (crowded && k % 2 == 1 ? 34 : 18)}, text, kInk);
    }
  }
  if (vertical) {
    write(image_, {8, kTop - 12}, axis.title, kInk);
  } else {
    write(image_, {static_cast<int>(plot_.x + plot_.width / 2) - width_of(axis.title) / 2, image_.rows - 10}, axis.title, kInk);
  }
  cv::rectangle(image_, cv::Rect(plot_), kInk, 1);
}

void Chart::point(double x, double y, const cv::Scalar& colour, int radius, bool filled) {
  cv::circle(image_, fine(at(x, y)), radius << kFine, colour, filled ? cv::FILLED : 2, cv::LINE_AA, kFine);
}

void Chart::line(double x0, double y0, double x1, double y1, const cv::Scalar& colour, int thickness) {
  cv::line(image_, fine(at(x0, y0)), fine(at(x1, y1)), colour, thickness, cv::LINE_AA, kFine);
}

void Chart::bar(double x, double low, double high, const cv::Scalar& colour) {
  // Cut off at the frame: an interval from two values may be wider than all data.
  const cv::Point2d a = at(x, std::clamp(low, y_.low, y_.high)), b = at(x, std::clamp(high, y_.low, y_.high));
  cv::line(image_, fine(a), fine(b), colour, 2, cv::LINE_AA, kFine);
  for (const cv::Point2d& end : {a, b}) cv::line(image_, fine({end.x - 5, end.y}), fine({end.x + 5, end.y}), colour, 2, cv::LINE_AA, kFine);
}

void Chart::cell(double x0, double y0, double x1, double y1, const cv::Scalar& colour) {
  cv::rectangle(image_, at(x0, y0), at(x1, y1), colour, cv::FILLED);
}

void Chart::label(double x, double y, const std::string& text, const cv::Scalar& colour, int dx, int dy) {
  const cv::Point2d p = at(x, y);
  const int room = image_.cols - 4 - width_of(text);
  write(image_, {std::min(static_cast<int>(p.x) + dx, room), static_cast<int>(p.y) + dy}, text, colour);
}

void Chart::legend(const std::vector<std::pair<std::string, cv::Scalar>>& entries) {
  int x = image_.cols - kRight;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    x -= width_of(entry->first) + 34;
    cv::circle(image_, {x + 8, kTop - 17}, 5, entry->second, cv::FILLED, cv::LINE_AA);
    write(image_, {x + 18, kTop - 12}, entry->first, kInk);
  }
}

}  // namespace waretwin
