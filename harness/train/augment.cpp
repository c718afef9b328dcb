#include "harness/train/augment.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

namespace waretwin::train {
namespace {

const cv::Scalar kGrey = cv::Scalar::all(114);  // beside a picture
constexpr float kLeastSide = 3.0f;              // pixels of the input; a smaller box shows nothing

struct Canvas {
  Sample sample;
  cv::Size size;
  double kept_share = 0.0;
};

// Which part of a picture is shown, in shares of it: about 1 / zoom of it, scaled by `width` and `height`, the shares of the input that it
// fills. It reaches over an edge only where it is larger than the picture, or by a tenth.
cv::Rect2d drawn_window(double width, double height, double zoom, double aspect, Dice& dice) {
  const double turn = std::sqrt(dice.factor(1.0 / (1.0 + aspect), 1.0 + aspect));
  const double w = width / zoom * turn, h = height / zoom / turn;
  const auto start = [&](double length) {
    const double slack = 0.1 * std::min(1.0, length);
    const double a = -slack, b = 1.0 - length + slack;
    return dice.between(std::min(a, b), std::max(a, b));
  };
  const double x = start(w);
  return {x, start(h), w, h};
}

// The window of the picture, mirrored or not, into `region` of the canvas.
void lay(const Sample& source, const cv::Rect2d& window, bool mirrored, const cv::Rect& region, Canvas& canvas) {
  const cv::Mat& picture = source.picture;
  // Pixels of the region from pixels of the picture, whose centres are at half.
  double ax = region.width / (window.width * picture.cols), bx = -window.x / window.width * region.width;
  const double ay = region.height / (window.height * picture.rows), by = -window.y / window.height * region.height;
  if (mirrored) {
    ax = -ax;
    bx = region.width - bx;
  }
  const cv::Matx23d centres(ax, 0, bx + 0.5 * ax - 0.5, 0, ay, by + 0.5 * ay - 0.5);
  cv::Mat target = canvas.sample.picture(region);
  cv::warpAffine(picture, target, centres, region.size(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, kGrey);

  const auto width = static_cast<float>(canvas.size.width), height = static_cast<float>(canvas.size.height);
  const cv::Rect2f bounds(region);
  for (const TruthBox& box : source.boxes) {
    const double x0 = ax * box.share.x * picture.cols + bx, x1 = ax * (box.share.x + box.share.width) * picture.cols + bx;
    const double y0 = ay * box.share.y * picture.rows + by, y1 = ay * (box.share.y + box.share.height) * picture.rows + by;
    const cv::Rect2f mapped(static_cast<float>(std::min(x0, x1)) + bounds.x, static_cast<float>(y0) + bounds.y,
                            static_cast<float>(std::abs(x1 - x0)), static_cast<float>(y1 - y0));
    const cv::Rect2f left = mapped & bounds;
    if (left.empty()) continue;
    const bool enough = left.area() >= canvas.kept_share * mapped.area() && std::min(left.width, left.height) >= kLeastSide;
    canvas.sample.boxes.push_back(
        {box.class_index, {left.x / width, left.y / height, left.width / width, left.height / height}, box.ignored || !enough});
  }
}

void lay_mosaic(const PictureSource& source, std::size_t count, std::size_t first, const AugmentConfig& config, Canvas& canvas,
                Dice& dice) {
  const int x = static_cast<int>(dice.between(0.3, 0.7) * canvas.size.width),
            y = static_cast<int>(dice.between(0.3, 0.7) * canvas.size.height);
  const int right = canvas.size.width - x, below = canvas.size.height - y;
  const std::array<cv::Rect, 4> regions = {cv::Rect(0, 0, x, y), cv::Rect(x, 0, right, y), cv::Rect(0, y, x, below),
                                           cv::Rect(x, y, right, below)};
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Sample one = source(i == 0 ? first : dice.number() % count);
    const cv::Rect& region = regions[i];
    const double zoom = dice.factor(0.4, 1.0);
    const cv::Rect2d window = drawn_window(static_cast<double>(region.width) / canvas.size.width,
                                           static_cast<double>(region.height) / canvas.size.height, zoom, config.aspect, dice);
    lay(one, window, dice.chance(config.flip), region, canvas);
  }
}

void change_colours(cv::Mat& picture, const AugmentConfig& config, Dice& dice) {
  const double hue = dice.between(-config.hue_deg, config.hue_deg) / 2.0;  // OpenCV counts in steps of 2 degrees
  const double saturation = dice.factor(1.0 / (1.0 + config.saturation), 1.0 + config.saturation);
  const double exposure = dice.factor(1.0 / (1.0 + config.exposure), 1.0 + config.exposure);
  cv::Mat table(1, 256, CV_8UC3);
  for (int i = 0; i < 256; ++i) {
    const int turned = (static_cast<int>(std::lround(i + hue)) % 180 + 180) % 180;
    table.at<cv::Vec3b>(0, i) = {static_cast<uchar>(turned), cv::saturate_cast<uchar>(saturation * i),
                                 cv::saturate_cast<uchar>(exposure * i)};
  }
  cv::Mat hsv;
  cv::cvtColor(picture, hsv, cv::COLOR_RGB2HSV);
  cv::LUT(hsv, table, hsv);
  cv::cvtColor(hsv, picture, cv::COLOR_HSV2RGB);
}

void change_sharpness(cv::Mat& picture, const AugmentConfig& config, Dice& dice) {
  if (dice.chance(config.blur)) {
    const double sigma = dice.between(0.3, 1.2);
    cv::GaussianBlur(picture, picture, {5, 5}, sigma);
  }
  if (dice.chance(config.noise)) {
    cv::Mat noise(picture.size(), CV_16SC3);
    const double sigma = dice.between(0.0, config.noise_sigma);
    cv::RNG(dice.number() + 1).fill(noise, cv::RNG::NORMAL, 0.0, std::max(sigma, 0.1));
    cv::add(picture, noise, picture, cv::noArray(), CV_8U);
  }
}

void cut_out(Canvas& canvas, Dice& dice) {
  const int pieces = 1 + static_cast<int>(dice.number() % 3);
  for (int i = 0; i < pieces; ++i) {
    const auto w = static_cast<float>(dice.between(0.05, 0.25)), h = static_cast<float>(dice.between(0.05, 0.35));
    const auto x = static_cast<float>(dice.between(0.0, 1.0)) - 0.5f * w, y = static_cast<float>(dice.between(0.0, 1.0)) - 0.5f * h;
    const cv::Rect2f piece(x, y, w, h);
    const cv::Rect pixels(static_cast<int>(x * canvas.size.width), static_cast<int>(y * canvas.size.height),
                          static_cast<int>(w * canvas.size.width), static_cast<int>(h * canvas.size.height));
    cv::rectangle(canvas.sample.picture, pixels, cv::Scalar(dice.between(0, 255), dice.between(0, 255), dice.between(0, 255)), cv::FILLED);
    for (TruthBox& box : canvas.sample.boxes) {
      if (box.share.area() - (box.share & piece).area() < canvas.kept_share * box.share.area()) box.ignored = true;
    }
  }
}

}  // namespace

Sample augmented(const PictureSource& source, std::size_t count, std::size_t first, const cv::Size& size, const AugmentConfig& config,
                 bool with_mosaic, Dice& dice) {
  Canvas canvas{{cv::Mat(size, CV_8UC3), {}}, size, config.kept_share};
  if (with_mosaic && dice.chance(config.mosaic)) {
    lay_mosaic(source, count, first, config, canvas, dice);
  } else {
    const cv::Rect2d window = drawn_window(1.0, 1.0, dice.factor(config.zoom_least, config.zoom_most), config.aspect, dice);
    lay(source(first), window, dice.chance(config.flip), {{0, 0}, size}, canvas);
  }
  change_colours(canvas.sample.picture, config, dice);
  if (dice.chance(config.cut_out)) cut_out(canvas, dice);
  change_sharpness(canvas.sample.picture, config, dice);
  return std::move(canvas.sample);
}

}  // namespace waretwin::train
