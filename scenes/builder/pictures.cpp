#include "scenes/builder/pictures.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "scenes/builder/paint.h"

namespace waretwin::builder {
namespace {

using cv::Mat;
using cv::Point;
using cv::Rect;
using cv::Scalar;

void fill(Mat& p, const Rect& area, const Scalar& colour) { cv::rectangle(p, area, colour, cv::FILLED); }

// Grey bars that read as lines of print from afar.
void print_lines(Mat& p, const Rect& area, int step, const Scalar& colour, const std::string& key) {
  const RandomStream random(0, key, "print");
  for (int y = area.y, i = 0; y + step / 2 <= area.y + area.height; y += step, ++i) {
    const double share = 0.6 + 0.4 * random.uniform(static_cast<std::uint64_t>(i));
    fill(p, {area.x, y, static_cast<int>(area.width * share), std::max(1, step / 2)}, colour);
  }
}

void warning_triangle(Mat& p, const Point& centre, int size) {
  const Point outer[] = {
      {centre.x, centre.y - size}, {centre.x + size, centre.y + size * 3 / 4}, {centre.x - size, centre.y + size * 3 / 4}};
  cv::fillConvexPoly(p, outer, 3, {20, 20, 20}, cv::LINE_AA);
  const int s = size * 4 / 5;
  const Point inner[] = {{centre.x, centre.y - s}, {centre.x + s, centre.y + s * 3 / 4 - 1}, {centre.x - s, centre.y + s * 3 / 4 - 1}};
  cv::fillConvexPoly(p, inner, 3, {20, 200, 250}, cv::LINE_AA);
  fill(p, {centre.x - size / 12, centre.y - size / 3, std::max(2, size / 6), size / 2}, {20, 20, 20});
  fill(p, {centre.x - size / 12, centre.y + size / 3, std::max(2, size / 6), std::max(2, size / 7)}, {20, 20, 20});
}

}  // namespace

Mat draw_status_screen() {
  Mat p(270, 480, CV_8UC3, Scalar(58, 46, 36));
  fill(p, {0, 0, 480, 30}, {120, 84, 30});
  put_text(p, "CELL 3  CONVEYOR CONTROL", 10, 21, 13, {240, 240, 240});
  const Scalar states[] = {{80, 190, 70}, {80, 190, 70}, {40, 180, 240}, {70, 70, 220}};
  for (int i = 0; i < 4; ++i) {
    const Rect box(12 + 116 * i, 44, 106, 84);
    fill(p, box, {84, 70, 58});
    fill(p, {box.x, box.y, box.width, 6}, states[i]);
    put_text(p, "M" + std::to_string(i + 1), box.x + 10, box.y + 36, 18, {235, 235, 235}, 1);
    print_lines(p, {box.x + 10, box.y + 50, 80, 28}, 10, {150, 140, 130}, "status" + std::to_string(i));
  }
  fill(p, {12, 142, 300, 114}, {40, 32, 26});
  for (int y = 156; y < 250; y += 20) cv::line(p, {12, y}, {311, y}, {62, 54, 46}, 1);
  const Mat noise = tiling_noise(300, 16, 12, 3, "status curve");
  for (int x = 1; x < 300; ++x) {
    const auto y = [&](int k) { return 240 - static_cast<int>(90 * noise.at<float>(3, k)); };
    cv::line(p, {12 + x - 1, y(x - 1)}, {12 + x, y(x)}, {110, 220, 120}, 2, cv::LINE_AA);
  }
  fill(p, {330, 142, 136, 50}, {60, 150, 60});
  put_text(p, "START", 366, 174, 14, {240, 250, 240});
  fill(p, {330, 206, 136, 50}, {50, 50, 200});
  put_text(p, "STOP", 372, 238, 14, {240, 240, 255});
  return p;
}

Mat draw_code_screen() {
  Mat p(270, 480, CV_8UC3, Scalar(34, 30, 28));
  fill(p, {0, 0, 90, 270}, {48, 43, 40});
  print_lines(p, {10, 14, 70, 250}, 12, {120, 112, 104}, "tree");
  const RandomStream random(0, "code", "print");
  const Scalar colours[] = {{214, 150, 90}, {120, 200, 150}, {180, 180, 180}, {90, 160, 220}, {180, 110, 200}};
  for (int i = 0; i < 21; ++i) {
    int x = 108 + 16 * static_cast<int>(random.uniform(static_cast<std::uint64_t>(i), 9) * 4);
    for (std::uint32_t word = 0; word < 6 && x < 430; ++word) {
      const int width = 8 + static_cast<int>(46 * random.uniform(static_cast<std::uint64_t>(i), word));
      fill(p, {x, 12 + 12 * i, std::min(width, 470 - x), 5}, colours[(static_cast<std::uint32_t>(i) * 3 + word) % 5]);
      x += width + 6;
    }
  }
  return p;
}

Mat draw_plot_screen() {
  Mat p(270, 480, CV_8UC3, Scalar(242, 242, 240));
  fill(p, {0, 0, 480, 24}, {214, 210, 206});
  put_text(p, "Point cloud viewer", 10, 17, 11, {60, 60, 60});
  fill(p, {10, 34, 330, 226}, {44, 34, 30});
  const RandomStream random(0, "cloud", "points");
  for (std::uint64_t i = 0; i < 2600; ++i) {
    const double t = random.uniform(i, 0), s = random.uniform(i, 1);
    const bool wall = random.uniform(i, 2) < 0.5;
    const int x = wall ? 40 + static_cast<int>(270 * t) : 70 + static_cast<int>(210 * t);
    const int y = wall ? 70 + static_cast<int>(50 * s + 26 * t) : 140 + static_cast<int>(90 * s);
    fill(p, {x, y, 2, 2}, wall ? Scalar(200, 150 + 60 * t, 90) : Scalar(90, 200, 120 + 80 * s));
  }
  fill(p, {352, 34, 118, 226}, {250, 250, 250});
  print_lines(p, {362, 46, 98, 206}, 14, {150, 150, 150}, "plot list");
  return p;
}

Mat draw_safety_poster() {
  Mat p(420, 297, CV_8UC3, Scalar(238, 240, 240));
  fill(p, {0, 0, 297, 66}, {24, 190, 245});
  put_text(p, "CAUTION", 52, 48, 36, {20, 20, 20}, 5);
  warning_triangle(p,
                   {
                       148,
                       152,
                   },
                   64);
  put_text(p, "MOBILE ROBOTS", 40, 240, 22, {30, 30, 30}, 2);
  put_text(p, "IN OPERATION", 54, 274, 22, {30, 30, 30}, 2);
  print_lines(p, {36, 300, 225, 60}, 15, {150, 150, 150}, "safety");
  fill(p, {0, 384, 297, 36}, {130, 80, 24});
  put_text(p, "KEEP THE LANES CLEAR", 44, 408, 15, {245, 245, 245});
  return p;
}

Mat draw_project_poster() {
  Mat p(560, 396, CV_8UC3, Scalar(246, 246, 246));
  fill(p, {0, 0, 396, 86}, {116, 140, 20});
  put_text(p, "Agile Production", 26, 40, 27, {250, 250, 250}, 2);
  put_text(p, "remanufacturing with learning robots", 26, 68, 13, {235, 245, 240});
  fill(p, {26, 108, 164, 122}, {196, 188, 176});
  cv::circle(p, {76, 166}, 34, {150, 140, 70}, cv::FILLED, cv::LINE_AA);
  fill(p, {106, 160, 70, 44}, {70, 170, 90});
  print_lines(p, {210, 112, 160, 116}, 12, {140, 140, 140}, "project a");
  fill(p, {26, 250, 344, 130}, {226, 222, 216});
  for (int i = 0; i < 4; ++i) {
    const Rect box(44 + 84 * i, 286, 60, 54);
    fill(p, box, i % 2 == 0 ? Scalar(120, 170, 90) : Scalar(190, 140, 80));
    if (i > 0) cv::arrowedLine(p, {box.x - 24, 313}, {box.x - 3, 313}, {70, 70, 70}, 2, cv::LINE_AA, 0, 0.4);
  }
  print_lines(p, {26, 398, 160, 130}, 12, {140, 140, 140}, "project b");
  print_lines(p, {210, 398, 160, 130}, 12, {140, 140, 140}, "project c");
  return p;
}

Mat draw_lifting_poster() {
  Mat p(420, 297, CV_8UC3, Scalar(236, 238, 238));
  fill(p, {0, 0, 297, 56}, {140, 84, 20});
  put_text(p, "LIFT SAFELY", 46, 38, 25, {250, 250, 250}, 2);
  for (int i = 0; i < 2; ++i) {
    const int y = 150 + 150 * i;
    cv::circle(p, {96, y - 54}, 15, {120, 84, 30}, cv::FILLED, cv::LINE_AA);
    cv::line(p, {96, y - 38}, {i == 0 ? 96 : 130, y + 10}, {120, 84, 30}, 12, cv::LINE_AA);
    cv::line(p, {100, y - 30}, {150, y + 6}, {120, 84, 30}, 8, cv::LINE_AA);
    cv::line(p, {i == 0 ? 96 : 130, y + 10}, {88, y + 48}, {120, 84, 30}, 10, cv::LINE_AA);
    fill(p, {144, y - 2, 46, 40}, {90, 140, 180});
    cv::circle(p, {246, y}, 24, i == 0 ? Scalar(70, 170, 60) : Scalar(50, 50, 210), 6, cv::LINE_AA);
  }
  print_lines(p, {30, 366, 236, 44}, 14, {150, 150, 150}, "lifting");
  return p;
}

Mat draw_whiteboard() {
  Mat p = mottled(480, 320, {240, 242, 242}, 3, 2, "whiteboard");
  cv::rectangle(p, Rect(0, 0, 480, 320), {150, 150, 148}, 8);
  put_text(p, "Week 34", 30, 52, 24, {160, 60, 30}, 2);
  cv::rectangle(p, Rect(40, 90, 110, 60), {40, 40, 40}, 2, cv::LINE_AA);
  cv::rectangle(p, Rect(220, 80, 120, 70), {40, 40, 200}, 2, cv::LINE_AA);
  cv::arrowedLine(p, {152, 120}, {216, 116}, {40, 40, 40}, 2, cv::LINE_AA);
  put_text(p, "scan", 64, 128, 20, {40, 40, 40});
  put_text(p, "map", 250, 126, 20, {40, 40, 200});
  for (int i = 0; i < 4; ++i) {
    cv::rectangle(p, Rect(44, 190 + 28 * i, 14, 14), {60, 110, 40}, 2);
    cv::line(p, {72, 198 + 28 * i}, {150 + 34 * ((i * 7) % 4), 196 + 28 * i}, {60, 110, 40}, 2, cv::LINE_AA);
  }
  fill(p, {380, 60, 50, 50}, {100, 220, 250});
  fill(p, {374, 130, 50, 50}, {150, 230, 170});
  fill(p, {386, 200, 50, 50}, {200, 170, 250});
  return p;
}

Mat draw_exit_sign() {
  Mat p(96, 192, CV_8UC3, Scalar(70, 150, 20));
  fill(p, {112, 14, 56, 70}, {235, 245, 235});
  cv::circle(p, {70, 26}, 8, {235, 245, 235}, cv::FILLED, cv::LINE_AA);
  cv::line(p, {66, 36}, {58, 56}, {235, 245, 235}, 9, cv::LINE_AA);
  cv::line(p, {58, 56}, {76, 66}, {235, 245, 235}, 6, cv::LINE_AA);
  cv::line(p, {76, 66}, {70, 82}, {235, 245, 235}, 6, cv::LINE_AA);
  cv::line(p, {58, 56}, {38, 72}, {235, 245, 235}, 6, cv::LINE_AA);
  cv::line(p, {66, 40}, {88, 50}, {235, 245, 235}, 5, cv::LINE_AA);
  return p;
}

Mat draw_type_label() {
  Mat p(96, 192, CV_8UC3, Scalar(212, 212, 210));
  cv::rectangle(p, Rect(2, 2, 188, 92), {60, 60, 60}, 1);
  put_text(p, "TRANSFER UNIT", 10, 22, 13, {30, 30, 30});
  print_lines(p, {10, 34, 84, 52}, 12, {110, 110, 110}, "type");
  draw_barcode(p, {108, 34, 74, 40}, "type");
  return p;
}

Mat draw_parcel_label() {
  Mat p(192, 128, CV_8UC3, Scalar(244, 245, 245));
  fill(p, {0, 0, 128, 26}, {30, 30, 30});
  put_text(p, "EXPRESS", 12, 19, 14, {245, 245, 245});
  print_lines(p, {10, 36, 86, 50}, 12, {110, 110, 110}, "parcel");
  cv::line(p, {0, 96}, {127, 96}, {40, 40, 40}, 1);
  draw_barcode(p, {10, 106, 108, 52}, "parcel");
  put_text(p, "00 3 4017", 24, 178, 11, {40, 40, 40});
  return p;
}

Mat draw_warning_label() {
  Mat p(128, 128, CV_8UC3, Scalar(30, 205, 250));
  warning_triangle(p, {64, 66}, 50);
  return p;
}

Mat draw_station_sign(int number) {
  Mat p(160, 160, CV_8UC3, Scalar(150, 88, 24));
  cv::rectangle(p, Rect(6, 6, 148, 148), {240, 240, 240}, 4);
  put_text(p, "ST", 22, 104, 52, {240, 240, 240}, 6);
  put_text(p, std::to_string(number), 106, 104, 52, {60, 220, 250}, 6);
  return p;
}

Mat draw_clock() {
  Mat p(128, 128, CV_8UC3, Scalar(226, 228, 228));
  cv::circle(p, {64, 64}, 60, {250, 250, 250}, cv::FILLED, cv::LINE_AA);
  cv::circle(p, {64, 64}, 60, {40, 40, 40}, 5, cv::LINE_AA);
  for (const Point& mark : {Point(64, 14), Point(114, 64), Point(64, 114), Point(14, 64)}) cv::circle(p, mark, 4, {30, 30, 30}, cv::FILLED);
  cv::line(p, {64, 64}, {88, 46}, {20, 20, 20}, 5, cv::LINE_AA);
  cv::line(p, {64, 64}, {52, 24}, {20, 20, 20}, 3, cv::LINE_AA);
  return p;
}

Mat draw_keyboard() {
  Mat p(72, 216, CV_8UC3, Scalar(32, 32, 32));
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 15; ++column) fill(p, {6 + 14 * column, 6 + 13 * row, 11, 10}, {58, 57, 56});
  }
  return p;
}

Mat draw_checkerboard() {
  constexpr int kSquare = 28, kBorder = 20;  // 2.5 mm a pixel on a board of 70 mm squares
  Mat p(7 * kSquare + 2 * kBorder, 10 * kSquare + 2 * kBorder, CV_8UC3, Scalar(236, 238, 238));
  for (int row = 0; row < 7; ++row) {
    for (int column = row % 2; column < 10; column += 2) {
      fill(p, {kBorder + column * kSquare, kBorder + row * kSquare, kSquare, kSquare}, {24, 24, 24});
    }
  }
  return p;
}

}  // namespace waretwin::builder
