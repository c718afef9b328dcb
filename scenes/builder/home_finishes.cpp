#include "scenes/builder/home_finishes.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "scenes/builder/finish_kinds.h"
#include "scenes/builder/finishes.h"
#include "scenes/builder/home_pictures.h"
#include "scenes/builder/paint.h"

namespace waretwin::builder {
namespace {

using cv::Scalar;
using Eigen::Vector3d;

// Planks of three lengths side by side, each of its own shade.
Finish parquet(const std::string& key, const Scalar& bgr, double reflectivity) {
  constexpr int kSize = 512, kRows = 8, kRow = kSize / kRows;
  cv::Mat t = mottled(kSize, kSize, bgr, 4, 4, key);
  add_streaks(t, 7, 128, key + " fibre");
  const RandomStream random(0, key, "planks");
  for (int row = 0; row < kRows; ++row) {
    const int first = static_cast<int>(random.uniform(static_cast<std::uint64_t>(row), 0) * kSize);
    // Two planks a row; the second begins somewhere about its middle.
    const int second = first + kSize * 2 / 5 + static_cast<int>(random.uniform(static_cast<std::uint64_t>(row), 1) * kSize / 5);
    for (const int plank : {0, 1}) {
      const int from = plank == 0 ? first : second, to = plank == 0 ? second : first + kSize;
      const double shade = 0.86 + 0.2 * random.uniform(static_cast<std::uint64_t>(row), static_cast<std::uint32_t>(2 + plank));
      for (int x = from; x < to; ++x) {
        for (int y = row * kRow; y < (row + 1) * kRow; ++y) t.at<cv::Vec3b>(y, x % kSize) *= shade;
      }
      const int joint = from % kSize;
      cv::line(t, {joint, row * kRow}, {joint, (row + 1) * kRow - 1}, bgr * 0.55, 1);
    }
    cv::line(t, {0, row * kRow}, {kSize - 1, row * kRow}, bgr * 0.6, 1);
  }
  return textured(t, 1.2, 1.2, 0, 0.55, reflectivity);
}

// Four tiles with their joints.
Finish tiles(const std::string& key, const Scalar& bgr, const Scalar& joint, double tile_m, double roughness, double reflectivity) {
  cv::Mat t = mottled(256, 256, bgr, 5, 3, key);
  const RandomStream random(0, key, "tiles");
  for (int i = 0; i < 4; ++i) {
    const double shade = 0.96 + 0.05 * random.uniform(static_cast<std::uint64_t>(i));
    for (int y = 0; y < 128; ++y) {
      for (int x = 0; x < 128; ++x) t.at<cv::Vec3b>(128 * (i / 2) + y, 128 * (i % 2) + x) *= shade;
    }
  }
  for (const int k : {0, 128}) {
    cv::rectangle(t, {k, 0}, {k + 2, 255}, joint, cv::FILLED);
    cv::rectangle(t, {0, k}, {255, k + 2}, joint, cv::FILLED);
  }
  return textured(t, 2 * tile_m, 2 * tile_m, 0, roughness, reflectivity);
}

// A knotted carpet as large as the texture: a border, a frame of lozenges, a field.
Finish carpet(const std::string& key, const Scalar& ground, const Scalar& border, double reflectivity) {
  cv::Mat t = mottled(480, 336, ground, 8, 10, key);
  cv::rectangle(t, {8, 8}, {471, 327}, border, 26);
  cv::rectangle(t, {34, 34}, {445, 301}, border * 0.6 + ground * 0.4, 4);
  const Scalar pale = border * 0.4 + Scalar(140, 150, 150);
  for (int x = 60; x < 440; x += 48) {
    for (int y = 62; y < 290; y += 48) {
      const cv::Point lozenge[] = {{x, y - 14}, {x + 14, y}, {x, y + 14}, {x - 14, y}};
      cv::fillConvexPoly(t, lozenge, 4, (x / 48 + y / 48) % 2 == 0 ? border : pale);
    }
  }
  for (int y = 0; y < t.rows; y += 3) cv::line(t, {0, y}, {t.cols - 1, y}, ground * 0.8, 1);
  return textured(t, 2.0, 1.4, 0, 0.97, reflectivity);
}

Finish striped(const std::string& key, const Scalar& a, const Scalar& b, const Scalar& thin) {
  cv::Mat t = mottled(256, 256, a, 4, 8, key);
  for (int x = 0; x < 256; x += 64) {
    cv::rectangle(t, {x, 0}, {x + 27, 255}, b, cv::FILLED);
    cv::rectangle(t, {x + 40, 0}, {x + 43, 255}, thin, cv::FILLED);
  }
  for (int y = 0; y < 256; y += 4) cv::line(t, {0, y}, {255, y}, a * 0.82, 1);
  return textured(t, 0.8, 0.8, 0, 0.95, 0.55);
}

// Even, without the dirt of painted metal.
Finish lacquered(const std::string& key, const Scalar& bgr, double roughness, double reflectivity) {
  return textured(mottled(128, 128, bgr, 2, 2, key), 0.8, 0.8, 0, roughness, reflectivity);
}

Finish leather(const std::string& key, const Scalar& bgr, double reflectivity) {
  cv::Mat t = mottled(256, 256, bgr, 7, 9, key);
  add_stains(t, -14, 0.6, 16, key + " grain");
  add_stains(t, 14, 0.66, 6, key + " worn");
  return textured(t, 0.4, 0.4, 0, 0.6, reflectivity);
}

Finish worktop() {
  cv::Mat t = mottled(256, 256, {92, 96, 98}, 8, 22, "worktop");
  add_stains(t, 34, 0.66, 32, "worktop specks");
  return textured(t, 0.6, 0.6, 0, 0.4, 0.35);
}

Finish linen(const std::string& key, const Scalar& bgr) {
  cv::Mat t = mottled(256, 256, bgr, 7, 3, key);
  add_streaks(t, 3, 32, key);
  return textured(t, 0.5, 0.5, 0, 0.95, 0.75);
}

}  // namespace

const std::map<std::string, Recipe>& home_recipes() {
  static const std::map<std::string, Recipe> table = {
      // Room
      {"parquet_oak",
       [] {
         return parquet("parquet", {112, 160, 196}, 0.55);
       }},
      {"floor_tiles",
       [] {
         return tiles("floor tiles", {150, 154, 156}, {112, 112, 112}, 0.30, 0.45, 0.45);
       }},
      {"bath_tiles",
       [] {
         return tiles("bath tiles", {222, 218, 208}, {176, 176, 174}, 0.20, 0.3, 0.65);
       }},
      {"kitchen_tiles",
       [] {
         return tiles("kitchen tiles", {206, 214, 216}, {160, 160, 158}, 0.10, 0.3, 0.65);
       }},
      {"wall_cream",
       [] {
         return wall_to_order("cream wall", {0.91, 0.89, 0.83}, 0.68);
       }},
      {"wall_sage",
       [] {
         return wall_to_order("sage wall", {0.76, 0.80, 0.73}, 0.62);
       }},
      {"wall_blue",
       [] {
         return wall_to_order("blue wall", {0.72, 0.79, 0.85}, 0.62);
       }},
      {"carpet_red",
       [] {
         return carpet("carpet", {60, 52, 128}, {110, 78, 40}, 0.45);
       }},
      {"bath_mat",
       [] {
         return fabric("bath mat", {168, 150, 110});
       }},
      {"curtain",
       [] {
         return linen("curtain", {150, 176, 188});
       }},
      // Wood and lacquer
      {"oak",
       [] {
         return wood("oak", {104, 150, 188}, 13);
       }},
      {"walnut",
       [] {
         return wood("walnut", {56, 84, 116}, 12);
       }},
      {"pine",
       [] {
         return wood("pine", {136, 186, 220}, 11);
       }},
      {"white_lacquer",
       [] {
         return lacquered("white lacquer", {226, 228, 228}, 0.45, 0.7);
       }},
      {"kitchen_front",
       [] {
         return lacquered("kitchen front", {206, 212, 206}, 0.45, 0.65);
       }},
      {"worktop", worktop},
      // Metal, ceramic, glass
      {"enamel",
       [] {
         return lacquered("enamel", {230, 232, 232}, 0.35, 0.72);
       }},
      {"ceramic",
       [] {
         return plain({0.92, 0.92, 0.90}, 0, 0.2, 0.75);
       }},
      {"black_glass",
       [] {
         return plain({0.05, 0.05, 0.06}, 0, 0.15, 0.08);
       }},
      {"dark_hollow",
       [] {
         return plain({0.30, 0.31, 0.32}, 0.2, 0.4, 0.3);
       }},
      // Cloth and leather
      {"fabric_grey",
       [] {
         return fabric("fabric grey", {128, 126, 122});
       }},
      {"fabric_green",
       [] {
         return fabric("fabric green", {84, 112, 74});
       }},
      {"fabric_beige",
       [] {
         return fabric("fabric beige", {150, 178, 194});
       }},
      {"fabric_mustard",
       [] {
         return fabric("fabric mustard", {40, 150, 204});
       }},
      {"fabric_rust",
       [] {
         return fabric("fabric rust", {52, 82, 168});
       }},
      {"linen_white",
       [] {
         return linen("linen", {226, 228, 228});
       }},
      {"blanket_blue",
       [] {
         return striped("blanket", {172, 140, 104}, {142, 98, 58}, {214, 222, 222});
       }},
      {"leather_brown",
       [] {
         return leather("leather", {44, 74, 120}, 0.4);
       }},
      {"leather_black",
       [] {
         return leather("black leather", {44, 42, 42}, 0.18);
       }},
      {"canvas_green",
       [] {
         return fabric("canvas green", {62, 92, 70});
       }},
      {"canvas_red",
       [] {
         return fabric("canvas red", {48, 44, 158});
       }},
      {"kraft_paper",
       [] {
         return plain({0.72, 0.56, 0.38}, 0, 0.9, 0.6);
       }},
      {"bread",
       [] {
         return plain({0.74, 0.50, 0.26}, 0, 0.8, 0.55);
       }},
      {"fruit_red",
       [] {
         return plain({0.72, 0.14, 0.10}, 0, 0.4, 0.55);
       }},
      {"fruit_green",
       [] {
         return plain({0.52, 0.68, 0.18}, 0, 0.4, 0.6);
       }},
      {"fruit_orange",
       [] {
         return plain({0.92, 0.52, 0.10}, 0, 0.5, 0.6);
       }},
      // Book covers
      {"cover_1",
       [] {
         return plain({0.15, 0.26, 0.48}, 0, 0.6, 0.4);
       }},
      {"cover_2",
       [] {
         return plain({0.58, 0.14, 0.12}, 0, 0.6, 0.45);
       }},
      {"cover_3",
       [] {
         return plain({0.18, 0.38, 0.26}, 0, 0.6, 0.4);
       }},
      {"cover_4",
       [] {
         return plain({0.84, 0.80, 0.70}, 0, 0.7, 0.65);
       }},
      {"cover_5",
       [] {
         return plain({0.80, 0.56, 0.14}, 0, 0.6, 0.55);
       }},
      {"cover_6",
       [] {
         return plain({0.20, 0.20, 0.22}, 0, 0.6, 0.2);
       }},
      {"cover_7",
       [] {
         return plain({0.44, 0.30, 0.50}, 0, 0.6, 0.45);
       }},
      // Light
      {"lamp_shade",
       [] {
         return glowing({0.85, 0.74, 0.56});
       }},
      // Pictures
      {"screen_landscape", [] { return screen(draw_landscape_screen()); }},
      {"painting_hills", [] { return picture_of(draw_hills_painting(), 0.8); }},
      {"painting_shapes", [] { return picture_of(draw_shapes_painting(), 0.8); }},
  };
  return table;
}

Finish parquet_to_order(const std::string& key, const Vector3d& colour, double reflectivity) {
  return parquet(key, bgr_of(colour), reflectivity);
}

Finish tiles_to_order(const std::string& key, const Vector3d& colour, double tile_m, double reflectivity) {
  return tiles(key, bgr_of(colour), bgr_of(colour) * 0.75, tile_m, 0.4, reflectivity);
}

Finish wood_to_order(const std::string& key, const Vector3d& colour, double reflectivity) {
  Finish f = wood(key, bgr_of(colour), 12);
  f.reflectivity_850nm = reflectivity;
  return f;
}

Finish fabric_to_order(const std::string& key, const Vector3d& colour, double reflectivity) {
  Finish f = fabric(key, bgr_of(colour));
  f.reflectivity_850nm = reflectivity;
  return f;
}

Finish carpet_to_order(const std::string& key, const Vector3d& ground, const Vector3d& border, double reflectivity) {
  return carpet(key, bgr_of(ground), bgr_of(border), reflectivity);
}

}  // namespace waretwin::builder
