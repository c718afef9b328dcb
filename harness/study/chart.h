// A plain chart as a picture: axes with round ticks, points, lines, bars of uncertainty.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace waretwin {

struct ChartAxis {
  std::string title;
  double low = 0.0, high = 1.0;     // of the data
  std::vector<std::string> levels;  // in place of numbers: one at each whole number from 0
};

class Chart {
 public:
  Chart(int width, int height, const std::string& title, const ChartAxis& x, const ChartAxis& y);

  // Colours are blue, green, red.
  void point(double x, double y, const cv::Scalar& colour, int radius, bool filled = true);
  void line(double x0, double y0, double x1, double y1, const cv::Scalar& colour, int thickness = 1);
  void bar(double x, double low, double high, const cv::Scalar& colour);  // of uncertainty
  void cell(double x0, double y0, double x1, double y1, const cv::Scalar& colour);
  void label(double x, double y, const std::string& text, const cv::Scalar& colour, int dx = 8, int dy = -6);
  // A row of names at the top right.
  void legend(const std::vector<std::pair<std::string, cv::Scalar>>& entries);

  cv::Mat& image() { return image_; }  // CV_8UC3, BGR

 private:
  cv::Point2d at(double x, double y) const;
  void draw_axis(const ChartAxis& axis, bool vertical);

  cv::Mat image_;
  cv::Rect2d plot_;
  ChartAxis x_, y_;
};

// Round numbers that divide [low, high] into about `count` parts.
std::vector<double> round_ticks(double low, double high, int count);

// From blue by green to yellow for 0 to 1; even in lightness, and readable by the colour-blind (after viridis).
cv::Scalar ramp_colour(double share);

}  // namespace waretwin
