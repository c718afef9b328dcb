#include "scenes/builder/finishes.h"

#include <functional>
#include <map>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "scenes/builder/finish_kinds.h"
#include "scenes/builder/home_finishes.h"
#include "scenes/builder/paint.h"
#include "scenes/builder/pictures.h"

namespace waretwin::builder {
namespace {

using cv::Scalar;

Finish concrete_floor() {
  cv::Mat t = mottled(1024, 1024, {186, 189, 188}, 14, 7, "floor");
  add_stains(t, -26, 0.60, 3, "floor wide");
  add_stains(t, 16, 0.62, 5, "floor bright");
  add_stains(t, -46, 0.71, 14, "floor spots");
  add_scratches(t, 140, 90, {120, 122, 122}, 0.4, "floor dark");
  add_scratches(t, 90, 60, {222, 224, 224}, 0.4, "floor pale");
  // Saw-cut joints, one a tile.
  cv::line(t, {0, 2}, {1023, 2}, {112, 114, 114}, 2);
  cv::line(t, {2, 0}, {2, 1023}, {112, 114, 114}, 2);
  return textured(t, 3.0, 3.0, 0.0, 0.75, 0.5);
}

// Worn streaks: whole patches of a few centimetres, so that no camera resolves them into specks.
Finish tyre_marks() {
  cv::Mat t(128, 512, CV_8UC4, Scalar(138, 138, 140, 0));
  const cv::Mat patches = tiling_noise(512, 128, 16, 2, "tyre gaps");
  const cv::Mat fade = tiling_noise(512, 128, 4, 2, "tyre fade");
  for (int y = 0; y < t.rows; ++y) {
    const bool groove = (y / 8) % 4 == 3;
    for (int x = 0; x < t.cols; ++x) {
      const double ink = 0.5 * static_cast<double>(patches.at<float>(y, x)) + 0.5 * static_cast<double>(fade.at<float>(y, x));
      t.at<cv::Vec4b>(y, x)[3] = !groove && ink > 0.5 ? 255 : 0;
    }
  }
  Finish f = textured(t, 1.6, 0.12, 0, 0.8, 0.2);
  f.alpha_mask = true;
  return f;
}

Finish hazard_tape() {
  cv::Mat t(64, 256, CV_8UC3, Scalar(32, 196, 240));
  for (int x = -64; x < 256; x += 64) {
    const cv::Point stripe[] = {{x, 64}, {x + 32, 64}, {x + 96, 0}, {x + 64, 0}};
    cv::fillConvexPoly(t, stripe, 4, {28, 28, 30});
  }
  add_stains(t, -50, 0.6, 8, "tape");
  add_scratches(t, 60, 14, {160, 165, 165}, 0.6, "tape");
  return textured(t, 0.4, 0.1, 0, 0.6, 0.4);
}

Finish yellow_tape() {
  cv::Mat t = mottled(256, 64, {40, 190, 235}, 10, 6, "yellow tape");
  add_stains(t, -60, 0.58, 8, "yellow tape");
  add_scratches(t, 70, 16, {165, 170, 170}, 0.7, "yellow tape");
  return textured(t, 1.0, 0.25, 0, 0.6, 0.55);
}

Finish rubber_belt() {
  // 0.6 m of belt: fine weave, a seam across, pale scuffs along the way of travel.
  cv::Mat t = mottled(512, 256, {44, 42, 41}, 6, 6, "belt");
  for (int y = 0; y < 256; y += 4) cv::line(t, {0, y}, {511, y}, {37, 35, 34}, 1);
  add_streaks(t, 5, 64, "belt");
  cv::line(t, {180, 0}, {196, 255}, {22, 21, 21}, 2);
  cv::line(t, {183, 0}, {199, 255}, {70, 68, 66}, 1);
  add_stains(t, 26, 0.64, 6, "belt dust");
  add_scratches(t, 60, 60, {104, 102, 100}, 0.5, "belt");
  return textured(t, 0.9, 0.45, 0, 0.85, 0.18);
}

Finish brushed_aluminium() {
  cv::Mat t = mottled(256, 256, {196, 194, 190}, 4, 2, "aluminium");
  add_streaks(t, 10, 64, "aluminium");
  add_stains(t, -24, 0.66, 5, "aluminium");
  add_scratches(t, 12, 30, {120, 120, 118}, 0.5, "aluminium");
  return textured(t, 0.5, 0.25, 0.35, 0.45, 0.6);
}

Finish chipboard() {
  cv::Mat t = mottled(512, 512, {128, 168, 196}, 8, 12, "chipboard");
  const RandomStream random(0, "chipboard", "chips");
  for (std::uint64_t i = 0; i < 1600; ++i) {
    const cv::Point at(static_cast<int>(random.uniform(i, 0) * 512), static_cast<int>(random.uniform(i, 1) * 512));
    const cv::Point to(at.x + static_cast<int>(random.uniform(i, 2) * 36) - 18, at.y + static_cast<int>(random.uniform(i, 3) * 36) - 18);
    const double shade = 0.72 + 0.5 * random.uniform(i, 4);
    cv::line(t, at, to, {128 * shade, 168 * shade, 196 * shade}, 1 + static_cast<int>(random.uniform(i, 5) * 4));
  }
  return textured(t, 0.8, 0.8, 0, 0.8, 0.6);
}

Finish cardboard() {
  cv::Mat t = mottled(256, 256, {104, 148, 186}, 8, 6, "cardboard");
  for (int x = 0; x < 256; x += 4) cv::line(t, {x, 0}, {x, 255}, {98, 141, 178}, 1);
  add_stains(t, -24, 0.62, 4, "cardboard");
  add_scratches(t, 30, 20, {80, 118, 150}, 0.5, "cardboard");
  return textured(t, 0.6, 0.6, 0, 0.85, 0.6);
}

Finish wall_paint() {
  cv::Mat t = mottled(512, 512, {220, 226, 228}, 3, 2, "wall");
  add_stains(t, -5, 0.6, 3, "wall");
  add_scratches(t, 40, 40, {190, 194, 196}, 0.4, "wall");
  return textured(t, 2.5, 2.5, 0, 0.9, 0.7);
}

Finish grey_wall() {
  cv::Mat t = mottled(512, 512, {182, 180, 176}, 3, 2, "grey wall");
  // Seams of the wall panels.
  for (const int x : {0, 256}) cv::line(t, {x, 0}, {x, 511}, {158, 156, 152}, 3);
  add_scratches(t, 20, 40, {160, 160, 158}, 0.4, "grey wall");
  return textured(t, 2.0, 2.0, 0, 0.85, 0.6);
}

Finish mesh_fence() {
  cv::Mat t(128, 128, CV_8UC4, Scalar(50, 52, 52, 0));
  cv::rectangle(t, {0, 0}, {127, 11}, {50, 52, 52, 255}, cv::FILLED);
  cv::rectangle(t, {0, 0}, {11, 127}, {50, 52, 52, 255}, cv::FILLED);
  Finish f = textured(t, 0.05, 0.05, 0.3, 0.6, 0.3);
  f.alpha_mask = true;
  f.double_sided = true;
  return f;
}

const std::map<std::string, Recipe>& recipes() {
  static const std::map<std::string, Recipe> table = {
      // Room
      {"concrete_floor", concrete_floor},
      {"tyre_marks", tyre_marks},
      {"hazard_tape", hazard_tape},
      {"yellow_tape", yellow_tape},
      {"wall_paint", wall_paint},
      {"wall_grey", grey_wall},
      {"ceiling",
       [] {
         return plain({0.93, 0.93, 0.92}, 0, 0.95, 0.7);
       }},
      {"skirting",
       [] {
         return plain({0.36, 0.37, 0.39}, 0, 0.7, 0.4);
       }},
      {"duct",
       [] {
         return plain({0.80, 0.81, 0.82}, 0, 0.6, 0.65);
       }},
      {"lamp",
       [] {
         return glowing({1.0, 0.98, 0.94});
       }},
      {"daylight",
       [] {
         return glowing({0.72, 0.86, 1.0});
       }},
      {"window_frame",
       [] {
         return plain({0.85, 0.86, 0.87}, 0.2, 0.5, 0.6);
       }},
      {"door_paint",
       [] {
         return painted("door", {150, 120, 82}, 0.6, 0.45, 12);
       }},
      {"gate",
       [] {
         return painted("gate", {196, 196, 192}, 0.6, 0.6, 40);
       }},
      // Metal and paint
      {"green_paint",
       [] {
         return painted("green", {54, 190, 72}, 0.45, 0.6, 30);
       }},
      {"cabinet_grey",
       [] {
         return painted("cabinet", {74, 70, 66}, 0.55, 0.35, 30);
       }},
      {"cabinet_top",
       [] {
         return painted("cabinet top", {96, 93, 90}, 0.6, 0.4, 90);
       }},
      {"light_grey_paint",
       [] {
         return painted("light grey", {206, 206, 203}, 0.5, 0.65, 12);
       }},
      {"black_paint",
       [] {
         return painted("black", {34, 34, 35}, 0.5, 0.15, 12);
       }},
      {"blue_paint",
       [] {
         return painted("blue", {150, 82, 30}, 0.5, 0.4, 25);
       }},
      {"orange_paint",
       [] {
         return painted("orange", {28, 102, 226}, 0.5, 0.6, 25);
       }},
      {"yellow_paint",
       [] {
         return painted("yellow", {24, 184, 238}, 0.5, 0.6, 30);
       }},
      {"red_paint",
       [] {
         return painted("red", {36, 34, 190}, 0.5, 0.45, 15);
       }},
      {"aluminium", brushed_aluminium},
      {"steel",
       [] {
         return plain({0.62, 0.62, 0.63}, 0.7, 0.4, 0.5);
       }},
      {"dark_steel",
       [] {
         return plain({0.30, 0.30, 0.31}, 0.5, 0.5, 0.3);
       }},
      {"chrome",
       [] {
         return plain({0.80, 0.80, 0.81}, 0.9, 0.2, 0.5);
       }},
      {"galvanised",
       [] {
         return painted("galvanised", {182, 180, 176}, 0.5, 0.55, 20);
       }},
      {"mesh_fence", mesh_fence},
      // Rubber, plastic
      {"rubber_belt", rubber_belt},
      {"roller_black",
       [] {
         return painted("roller", {44, 43, 43}, 0.55, 0.16, 30);
       }},
      {"roller_steel",
       [] {
         return plain({0.70, 0.70, 0.70}, 0.6, 0.35, 0.5);
       }},
      {"rubber",
       [] {
         return plain({0.09, 0.09, 0.09}, 0, 0.9, 0.12);
       }},
      {"black_plastic",
       [] {
         return plain({0.11, 0.11, 0.12}, 0, 0.5, 0.15);
       }},
      {"grey_plastic",
       [] {
         return plain({0.50, 0.51, 0.52}, 0, 0.6, 0.45);
       }},
      {"white_plastic",
       [] {
         return plain({0.88, 0.88, 0.87}, 0, 0.5, 0.75);
       }},
      {"bin_green",
       [] {
         return plain({0.16, 0.50, 0.22}, 0, 0.5, 0.5);
       }},
      {"bin_blue",
       [] {
         return plain({0.12, 0.28, 0.60}, 0, 0.5, 0.45);
       }},
      {"bin_red",
       [] {
         return plain({0.70, 0.12, 0.11}, 0, 0.5, 0.5);
       }},
      {"joint_blue",
       [] {
         return plain({0.52, 0.76, 0.88}, 0, 0.45, 0.6);
       }},
      {"robot_grey",
       [] {
         return plain({0.78, 0.79, 0.80}, 0.2, 0.45, 0.6);
       }},
      {"cable_black",
       [] {
         return plain({0.07, 0.07, 0.07}, 0, 0.6, 0.1);
       }},
      {"cable_blue",
       [] {
         return plain({0.10, 0.25, 0.62}, 0, 0.6, 0.3);
       }},
      {"cable_yellow",
       [] {
         return plain({0.88, 0.74, 0.10}, 0, 0.6, 0.5);
       }},
      {"cable_grey",
       [] {
         return plain({0.55, 0.55, 0.55}, 0, 0.6, 0.4);
       }},
      {"esd_mat",
       [] {
         return painted("mat", {148, 120, 92}, 0.9, 0.4, 20);
       }},
      {"stretch_film",
       [] {
         return plain({0.82, 0.86, 0.88}, 0.1, 0.2, 0.5);
       }},
      // Wood, board, cloth
      {"birch",
       [] {
         return wood("birch", {150, 192, 218}, 9);
       }},
      {"beech",
       [] {
         return wood("beech", {110, 158, 196}, 12);
       }},
      {"pallet_wood",
       [] {
         return wood("pallet", {112, 156, 184}, 20);
       }},
      {"chipboard", chipboard},
      {"table_top",
       [] {
         return painted("table top", {208, 210, 208}, 0.5, 0.7, 30);
       }},
      {"cardboard", cardboard},
      {"packing_tape",
       [] {
         return plain({0.62, 0.46, 0.26}, 0, 0.3, 0.5);
       }},
      {"fabric_black",
       [] {
         return fabric("fabric black", {42, 40, 40});
       }},
      {"fabric_blue",
       [] {
         return fabric("fabric blue", {112, 66, 36});
       }},
      {"skin",
       [] {
         return plain({0.80, 0.58, 0.47}, 0, 0.6, 0.6);
       }},
      {"reflective_stripe",
       [] {
         Finish f = plain({0.82, 0.83, 0.84}, 0, 0.4, 0.9);
         f.retroreflective = true;
         return f;
       }},
      {"paper",
       [] {
         return plain({0.93, 0.93, 0.91}, 0, 0.9, 0.8);
       }},
      {"leaf",
       [] {
         return plain({0.14, 0.36, 0.12}, 0, 0.7, 0.6);
       }},
      {"soil",
       [] {
         return plain({0.16, 0.11, 0.08}, 0, 0.95, 0.3);
       }},
      // Pictures
      {"screen_status", [] { return screen(draw_status_screen()); }},
      {"screen_code", [] { return screen(draw_code_screen()); }},
      {"screen_plot", [] { return screen(draw_plot_screen()); }},
      {"poster_safety", [] { return picture_of(draw_safety_poster()); }},
      {"poster_project", [] { return picture_of(draw_project_poster()); }},
      {"poster_lifting", [] { return picture_of(draw_lifting_poster()); }},
      {"whiteboard", [] { return picture_of(draw_whiteboard(), 0.25, 0.8); }},
      {"sign_exit", [] { return screen(draw_exit_sign()); }},
      {"label_type", [] { return picture_of(draw_type_label()); }},
      {"label_parcel", [] { return picture_of(draw_parcel_label()); }},
      {"label_warning", [] { return picture_of(draw_warning_label()); }},
      {"marker_1", [] { return picture_of(draw_station_sign(1)); }},
      {"marker_2", [] { return picture_of(draw_station_sign(2)); }},
      {"marker_3", [] { return picture_of(draw_station_sign(3)); }},
      {"marker_4", [] { return picture_of(draw_station_sign(4)); }},
      {"checkerboard", [] { return picture_of(draw_checkerboard(), 0.9); }},
      {"clock", [] { return picture_of(draw_clock()); }},
      {"keyboard", [] { return picture_of(draw_keyboard(), 0.6, 0.15); }},
  };
  return table;
}

}  // namespace

Finish paint_to_order(const std::string& key, const Eigen::Vector3d& colour, double roughness, double reflectivity) {
  return painted(key, bgr_of(colour), roughness, reflectivity, 22);
}

Finish belt_to_order(const std::string& key, const Eigen::Vector3d& colour, double reflectivity) {
  const Scalar bgr = bgr_of(colour);
  cv::Mat t = mottled(256, 128, bgr, 6, 6, key);
  for (int y = 0; y < t.rows; y += 4) cv::line(t, {0, y}, {t.cols - 1, y}, bgr * 0.86, 1);
  add_streaks(t, 5, 32, key);
  add_stains(t, colour.mean() > 0.4 ? -24 : 22, 0.63, 5, key);
  const double seam = RandomStream(0, key, "seam").uniform(0) * 200;
  cv::line(t, {static_cast<int>(seam), 0}, {static_cast<int>(seam) + 10, t.rows - 1}, bgr * 0.6, 2);
  return textured(t, 0.9, 0.45, 0, 0.8, reflectivity);
}

Finish floor_to_order(const std::string& key, const Eigen::Vector3d& colour, double wear, double reflectivity) {
  const Scalar bgr = bgr_of(colour);
  cv::Mat t = mottled(512, 512, bgr, 4 + 9 * wear, 3 + 4 * wear, key);
  add_stains(t, -12 - 18 * wear, 0.61, 3, key + " wide");
  add_stains(t, -20 - 26 * wear, 0.71, 10, key + " spots");
  add_scratches(t, static_cast<int>(70 * wear), 45, bgr * 0.65, 0.4, key + " dark");
  add_scratches(t, static_cast<int>(50 * wear), 30, bgr * 1.18, 0.4, key + " pale");
  cv::line(t, {0, 1}, {511, 1}, bgr * 0.62, 1);
  cv::line(t, {1, 0}, {1, 511}, bgr * 0.62, 1);
  return textured(t, 2.5, 2.5, 0.0, 0.85 - 0.35 * (1 - wear), reflectivity);
}

Finish wall_to_order(const std::string& key, const Eigen::Vector3d& colour, double reflectivity) {
  const Scalar bgr = bgr_of(colour);
  cv::Mat t = mottled(256, 256, bgr, 2, 1.5, key);
  add_stains(t, -4, 0.6, 3, key);
  add_scratches(t, 12, 22, bgr * 0.88, 0.4, key);
  return textured(t, 2.5, 2.5, 0, 0.9, reflectivity);
}

Finish plain_to_order(const Eigen::Vector3d& colour, double roughness, double reflectivity) {
  return plain(colour, 0.0, roughness, reflectivity);
}

Finish make_finish(const std::string& name) {
  auto found = recipes().find(name);
  if (found == recipes().end()) found = home_recipes().find(name);
  WARETWIN_CHECK(found != home_recipes().end(), name);
  Finish finish = found->second();
  finish.name = name;
  return finish;
}

std::vector<std::string> finish_names() {
  std::vector<std::string> names;
  for (const auto* table : {&recipes(), &home_recipes()}) {
    for (const auto& entry : *table) names.push_back(entry.first);
  }
  return names;
}

}  // namespace waretwin::builder
