#include "harness/truth/mask_outlines.h"

#include <array>
#include <cstdint>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/error.h"

namespace waretwin {

namespace {

// Clockwise in a picture, whose y points down; a pixel's edges walked this way have the pixel on their right.
enum Way : int { kRight, kDown, kLeft, kUp };
const std::array<cv::Point, 4> kStep = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

using Loop = std::vector<cv::Point>;

// Closed walks along the edges between set and unset pixels, corners only. By component: the outer one and those around holes.
struct Walks {
  std::map<int, Loop> outer;
  std::map<int, std::vector<Loop>> holes;
};

Walks walk_edges(const cv::Mat& mask) {
  cv::Mat padded, components;
  cv::copyMakeBorder(mask, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
  cv::connectedComponents(padded, components, 4, CV_32S);
  const auto set = [&](int x, int y) { return padded.at<std::uint8_t>(y + 1, x + 1) != 0; };
  // The edge that leaves a corner point in a direction: 1 where it is there and has not been walked.
  const auto has_edge = [&](const cv::Point& p, int way) {
    switch (way) {
      case kRight:
        return set(p.x, p.y) && !set(p.x, p.y - 1);
      case kDown:
        return set(p.x - 1, p.y) && !set(p.x, p.y);
      case kLeft:
        return set(p.x - 1, p.y - 1) && !set(p.x - 1, p.y);
      default:
        return set(p.x, p.y - 1) && !set(p.x - 1, p.y - 1);
    }
  };
  // Every loop has an edge to the right; those that were walked are marked.
  cv::Mat walked = cv::Mat::zeros(mask.rows + 1, mask.cols + 1, CV_8UC1);
  Walks walks;
  for (int y = 0; y <= mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (!has_edge({x, y}, kRight) || walked.at<std::uint8_t>(y, x) != 0) continue;
      Loop loop;
      cv::Point at(x, y);
      int way = kRight, last = -1;
      long area = 0;  // twice, signed
      do {
        if (way == kRight) walked.at<std::uint8_t>(at.y, at.x) = 1;
        if (way != last) loop.push_back(at);
        last = way;
        const cv::Point next = at + kStep[static_cast<std::size_t>(way)];
        area += static_cast<long>(at.x) * next.y - static_cast<long>(next.x) * at.y;
        at = next;
        // Where two pixels touch at a corner, turning right stays with the same one.
        for (const int turn : {1, 0, 3}) {
          const int tried = (way + turn) % 4;
          if (!has_edge(at, tried)) continue;
          way = tried;
          break;
        }
      } while (at != cv::Point(x, y) || way != kRight);
      if (loop.size() > 1 && last == kRight) loop.erase(loop.begin());  // began in the middle of a straight
      const int component = components.at<int>(y + 1, x + 1);
      if (area > 0) {
        walks.outer[component] = std::move(loop);
      } else {
        walks.holes[component].push_back(std::move(loop));
      }
    }
  }
  return walks;
}

std::vector<cv::Point2f> simplified(const Loop& loop, double tolerance) {
  std::vector<cv::Point2f> points(loop.begin(), loop.end()), fewer;
  if (!(tolerance > 0.0)) return points;
  cv::approxPolyDP(points, fewer, tolerance, true);
  return fewer.size() < 3 ? points : fewer;
}

}  // namespace

std::vector<std::vector<double>> outlines(const cv::Mat& mask, const cv::Point& place, double tolerance_px) {
  WARETWIN_CHECK(mask.type() == CV_8UC1, "a mask");
  const Walks walks = walk_edges(mask);
  std::vector<std::vector<double>> polygons;
  for (const auto& [component, outer] : walks.outer) {
    std::vector<double>& polygon = polygons.emplace_back();
    const auto add = [&](const cv::Point2f& p) {
      polygon.push_back(static_cast<double>(p.x) + place.x);
      polygon.push_back(static_cast<double>(p.y) + place.y);
    };
    const std::vector<cv::Point2f> around = simplified(outer, tolerance_px);
    for (const cv::Point2f& p : around) add(p);
    const auto holes = walks.holes.find(component);
    if (holes == walks.holes.end()) continue;
    for (const Loop& hole : holes->second) {
      add(around.front());
      const std::vector<cv::Point2f> inside = simplified(hole, tolerance_px);
      for (const cv::Point2f& p : inside) add(p);
      add(inside.front());
    }
    add(around.front());
  }
  return polygons;
}

}  // namespace waretwin
