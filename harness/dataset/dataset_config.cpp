#include "harness/dataset/dataset_config.h"

#include <algorithm>

#include "sim/ray_caster.h"

namespace waretwin {

void ViewConfig::visit(Fields& f) {
  f("route_share", route_share, "of the pictures, taken from the vehicle's mount along the route", {.min = 0, .max = 1});
  f("empty_share", empty_share, "of the pictures, without any object", {.min = 0, .max = 1});
  if (route_share + empty_share > 1.0) f.reject("empty_share", "route_share and empty_share add up to more than 1");
  f("distance_min_m", distance_min_m, "around objects: nearest to the object's middle", {.min = 0.1, .max = 100});
  f("distance_max_m", distance_max_m, "around objects: farthest from the object's middle", {.min = 0.1, .max = 100});
  if (distance_max_m < distance_min_m) f.reject("distance_max_m", "is below distance_min_m");
  f("height_min_m", height_min_m, "around objects: lowest camera", {.min = 0, .max = 100});
  f("height_max_m", height_max_m, "around objects: highest camera", {.min = 0, .max = 100});
  if (height_max_m < height_min_m) f.reject("height_max_m", "is below height_min_m");
  f("roll_deg", roll_deg, "the camera is tilted sideways by up to this", {.min = 0, .max = 180});
  f("least_share", least_share, "of the picture that the object fills at least in views around objects", {.min = 0, .max = 0.5});
  f("speed_mps", speed_mps, "around objects: the camera moves by up to this during the exposure", {.min = 0, .max = 20});
  f("turn_rate_deg_s", turn_rate_deg_s, "and turns by up to this", {.min = 0, .max = 720});
}

void CameraVariation::visit(Fields& f) {
  f("name", name, "which camera of the scenario; empty: the first");
  f("field_share", field_share, "of both fields of view, +-", {.min = 0, .max = 0.5});
  f("height_m", height_m, "of the mount, +-", {.min = 0, .max = 10});
  f("place_m", place_m, "of the mount, forwards and sideways, +-", {.min = 0, .max = 10});
  f("pitch_deg", pitch_deg, "of the mount, +-", {.min = 0, .max = 90});
  f("yaw_deg", yaw_deg, "of the mount, +-", {.min = 0, .max = 180});
  f("exposure_stops", exposure_stops, "brightness of the picture, +- powers of two", {.min = 0, .max = 4});
  f("noise_stops", noise_stops, "sensitivity of the sensor, +- powers of two", {.min = 0, .max = 6});
}

void LightVariation::visit(Fields& f) {
  f("strength_stops", strength_stops, "of each lamp, +- powers of two", {.min = 0, .max = 6});
  f("ambient_stops", ambient_stops, "of the light from everywhere, +- powers of two", {.min = 0, .max = 6});
  f("tint", tint, "of each lamp's red and blue, +-", {.min = 0, .max = 0.9});
  f("off_share", off_share, "of the lamps that are off; one stays on", {.min = 0, .max = 1});
}

void MaterialVariation::visit(Fields& f) {
  f("tint_share", tint_share, "of the materials whose colour is shifted", {.min = 0, .max = 1});
  f("tint", tint, "by up to this share of the range, +-", {.min = 0, .max = 1});
  f("repaint_share", repaint_share, "of the materials that get another colour altogether", {.min = 0, .max = 1});
  f("pattern_share", pattern_share, "of the materials that get a drawn pattern", {.min = 0, .max = 1});
  f("dirt_share", dirt_share, "of the materials that get stains", {.min = 0, .max = 1});
  f("roughness", roughness, "+-", {.min = 0, .max = 1});
}

void ThingsVariation::visit(Fields& f) {
  f("loose_max", loose_max, "things dropped about the hall, at most", {.min = 0, .max = 500});
  f("parcels_max", parcels_max, "things dropped on objects, at most", {.min = 0, .max = 500});
  f("standing_max", standing_max, "things put up beside the hall's own, at most", {.min = 0, .max = 500});
}

int DatasetConfig::hall_size() const {
  constexpr int kHalls = 400, kMost = 10;
  return images_per_hall > 0 ? images_per_hall : std::clamp(count / kHalls, 1, kMost);
}

void DatasetConfig::visit(Fields& f) {
  f("seed", seed, "of everything that is drawn");
  f("count", count, "pictures", {.min = 1, .max = 10000000});
  f("images_per_hall", images_per_hall, "with one hall, light, materials and things; 0: as many as make four hundred halls, at most 10",
    {.min = 0, .max = 100000});
  f("valid_share", valid_share, "of the halls, for validation", {.min = 0, .max = 1});
  f("test_share", test_share, "of the halls, for testing", {.min = 0, .max = 1});
  if (valid_share + test_share > 1.0) f.reject("test_share", "valid_share and test_share add up to more than 1");
  f("jpeg_quality", jpeg_quality, "of the pictures", {.min = 1, .max = 100});
  f("depth", depth, "also true depth in millimetres as 16-bit PNG");
  f("instances", instances, "also object ids as 16-bit PNG");
  f("polygon_tolerance_px", polygon_tolerance_px, "COCO polygons leave out points that are no farther from them; 0: exact",
    {.min = 0, .max = 100});
  f("classes", classes, "that are labelled, in this order; empty: all that the halls have, by name");
  f.group("labels", labels, "which objects get a label");
  f.group("views", views, "where pictures are taken from");
  f.group("camera", camera, "the camera, drawn anew for each hall");
  f.group("light", light, "drawn anew for each hall");
  f.group("materials", materials, "drawn anew for each hall");
  f.group("things", things, "put into each hall, none of them an object");
  f.group("render", render, "how pictures are made");
  RayCasterOptions caster;
  caster.isa = isa;
  caster.visit(f);
  isa = caster.isa;
}

}  // namespace waretwin
