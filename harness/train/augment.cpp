#include "harness/train/augment.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "mapper/detect/resized_picture.h"

namespace waretwin::train {
namespace {

constexpr double kWholeShare = 0.5;  // of the late pictures: as a detector sees them
constexpr double kMosaicZoomLeast = 0.5, kMosaicZoomMost = 1.4;
const cv::Scalar kGrey = cv::Scalar::all(114);  // beside a picture
constexpr float kLeastSide = 6.0f;              // pixels of the input, the longer one; a smaller box shows nothing

struct Canvas {
  Sample sample;
  cv::Size size;
  double kept_share = 0.0;
  std::vector<double> kept = {};  // by box: the share of it that is still shown
};

// Which part of a picture is shown, in shares of it: about 1 / zoom of it, scaled by `width` and `height`, the shares of the input that it
// fills. It reaches over an edge only where it is longer than the picture.
cv::Rect2d drawn_window(double width, double height, double zoom, double aspect, Dice& dice) {
  const double turn = std::sqrt(dice.factor(1.0 / (1.0 + aspect), 1.0 + aspect));
  const double w = width / zoom * turn, h = height / zoom / turn;
  const auto start = [&](double length) { return dice.between(std::min(0.0, 1.0 - length), std::max(0.0, 1.0 - length)); };
  const double x = start(w);
  return {x, start(h), w, h};
}

// A stretch of a picture's side and where it comes to lie, both in whole pixels.
struct Stretch {
  int from = 0, length = 0;  // of the picture
  int to = 0, size = 0;      // of the region
  double scale() const { return static_cast<double>(size) / length; }
};

// The part of the window (start and length as shares of the side) that the picture has.
Stretch stretch_of(double start, double length, int side, int region) {
  Stretch out;
  const double first = std::clamp(start, 0.0, 1.0), last = std::clamp(start + length, 0.0, 1.0);
  out.from = std::clamp(static_cast<int>(std::lround(first * side)), 0, side - 1);
  out.length = std::clamp(static_cast<int>(std::lround(last * side)) - out.from, 1, side - out.from);
  out.to = std::clamp(static_cast<int>(std::lround((first - start) / length * region)), 0, region - 1);
  out.size = std::clamp(static_cast<int>(std::lround((last - first) / length * region)), 1, region - out.to);
  return out;
}

// The window of the picture, mirrored or not, into `region` of the canvas.
void lay(const Sample& source, const cv::Rect2d& window, bool mirrored, const cv::Rect& region, Canvas& canvas) {
  const cv::Mat& picture = source.picture;
  Stretch across = stretch_of(window.x, window.width, picture.cols, region.width);
  const Stretch down = stretch_of(window.y, window.height, picture.rows, region.height);
  const cv::Mat part = picture(cv::Rect(across.from, down.from, across.length, down.length));
  cv::Mat shown(down.size, across.size, CV_8UC3);
  resize_picture(part, shown);
  if (mirrored) {
    cv::flip(shown, shown, 1);
    across.to = region.width - across.to - across.size;
  }
  cv::Mat target = canvas.sample.picture(region);
  target.setTo(kGrey);
  shown.copyTo(target(cv::Rect(across.to, down.to, across.size, down.size)));

  const auto width = static_cast<float>(canvas.size.width), height = static_cast<float>(canvas.size.height);
  const cv::Rect2f bounds(static_cast<float>(region.x + across.to), static_cast<float>(region.y + down.to), static_cast<float>(across.size),
                          static_cast<float>(down.size));
  for (const TruthBox& box : source.boxes) {
    const double w = box.share.width * picture.cols * across.scale(), h = box.share.height * picture.rows * down.scale();
    double x = (box.share.x * picture.cols - across.from) * across.scale();
    const double y = (box.share.y * picture.rows - down.from) * down.scale();
    if (mirrored) x = across.size - x - w;
    const cv::Rect2f mapped(static_cast<float>(x) + bounds.x, static_cast<float>(y) + bounds.y, static_cast<float>(w),
                            static_cast<float>(h));
    const cv::Rect2f left = mapped & bounds;
    if (left.empty()) continue;
    const double kept = left.area() / mapped.area();
    const bool enough = kept >= canvas.kept_share && std::max(left.width, left.height) >= kLeastSide;
    canvas.sample.boxes.push_back(
        {box.class_index, {left.x / width, left.y / height, left.width / width, left.height / height}, box.ignored || !enough});
    canvas.kept.push_back(kept);
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
    const double zoom = dice.factor(kMosaicZoomLeast, kMosaicZoomMost);
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

// What is left of a box where a piece covers its whole height or width from one side on: a label is the extent of what is seen.
cv::Rect2f without(const cv::Rect2f& box, const cv::Rect2f& piece) {
  float left = box.x, top = box.y, right = box.br().x, bottom = box.br().y;
  if (piece.y <= top && piece.br().y >= bottom) {
    if (piece.x <= left) left = std::max(left, std::min(right, piece.br().x));
    if (piece.br().x >= right) right = std::min(right, std::max(left, piece.x));
  }
  if (piece.x <= left && piece.br().x >= right) {
    if (piece.y <= top) top = std::max(top, std::min(bottom, piece.br().y));
    if (piece.br().y >= bottom) bottom = std::min(bottom, std::max(top, piece.y));
  }
  const cv::Rect2f rest(left, top, right - left, bottom - top);
  return rest.empty() ? box : rest;
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
    for (std::size_t k = 0; k < canvas.sample.boxes.size(); ++k) {
      TruthBox& box = canvas.sample.boxes[k];
      const float whole = box.share.area();
      canvas.kept[k] *= 1.0 - (box.share & piece).area() / whole;
      box.share = without(box.share, piece);
      if (canvas.kept[k] < canvas.kept_share) box.ignored = true;
    }
  }
}

}  // namespace

Sample augmented(const PictureSource& source, std::size_t count, std::size_t first, const cv::Size& size, const AugmentConfig& config,
                 bool late, Dice& dice) {
  Canvas canvas{{cv::Mat(size, CV_8UC3), {}}, size, config.kept_share};
  const bool whole = late && dice.chance(kWholeShare);
  if (!late && dice.chance(config.mosaic)) {
    lay_mosaic(source, count, first, config, canvas, dice);
  } else {
    const cv::Rect2d window =
        whole ? cv::Rect2d(0, 0, 1, 1) : drawn_window(1.0, 1.0, dice.factor(config.zoom_least, config.zoom_most), config.aspect, dice);
    lay(source(first), window, dice.chance(config.flip), {{0, 0}, size}, canvas);
  }
  change_colours(canvas.sample.picture, config, dice);
  if (!whole && dice.chance(config.cut_out)) cut_out(canvas, dice);
  change_sharpness(canvas.sample.picture, config, dice);
  return std::move(canvas.sample);
}

}  // namespace waretwin::train
