#include "scenes/motion_config.h"

#include "scenes/model_file.h"

namespace waretwin {

namespace {

constexpr double kFar_m = 1e5, kHigh_m = 1e3;

}  // namespace

void BeltChange::visit(Fields& f) {
  f("at_s", at_s, "time of the drive", {.min = -3600, .max = 1e6, .required = true});
  f("speed_mps", speed_mps, "speed from then on; 0 stops, negative runs backwards", {.min = -5, .max = 5, .required = true});
}

void BeltConfig::visit(Fields& f) {
  f("object", object, "names of true objects; * stands for any text, ? for one letter", {.required = true});
  f("speed_mps", speed_mps, "surface speed; of a curve, that of its centre line", {.min = -5, .max = 5});
  f("heading_deg", heading_deg, "straight belts: world direction of travel", {.min = -360, .max = 360});
  f("curve", curve, "turns about pivot_x_m, pivot_y_m, counter-clockwise");
  f("pivot_x_m", pivot_x_m, "curve: its vertical axis", {.min = -kFar_m, .max = kFar_m});
  f("pivot_y_m", pivot_y_m, "curve: its vertical axis", {.min = -kFar_m, .max = kFar_m});
  f("acceleration_mps2", acceleration_mps2, "of start and stop", {.min = 0.01, .max = 100});
  f("friction", friction, "with what lies on it", {.min = 0, .max = 2});
  f.list("changes", changes, "start and stop, in order of time");
  if (object.empty()) f.reject("object", "is empty; expected the name of an object such as 'conveyor_*'");
  for (std::size_t i = 1; i < changes.size(); ++i) {
    if (changes[i].at_s <= changes[i - 1].at_s) f.reject("changes", "are not in order of at_s; each must be later than the one before");
  }
}

void ItemBody::visit(Fields& f) {
  visit_model_file(f, file, folder);
  f("mass_kg", mass_kg, "of one item", {.min = 0.01, .max = 2000});
  f("friction", friction, "Coulomb; with another surface the root of both coefficients' product counts", {.min = 0, .max = 2});
}

void ItemStream::visit(Fields& f) {
  f("name", name, "of its items; the file's stem where empty");
  body.visit(f);
  f("x_m", x_m, "where items appear: the model's origin", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("y_m", y_m, "where items appear", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("z_m", z_m, "where items appear; they fall from there", {.min = 0, .max = kHigh_m, .required = true});
  f("yaw_deg", yaw_deg, "how they are turned", {.min = -360, .max = 360});
  f("yaw_spread_deg", yaw_spread_deg, "each is turned by up to this either way", {.min = 0, .max = 180});
  f("side_spread_m", side_spread_m, "each is moved across its yaw by up to this either way", {.min = 0, .max = 5});
  f("first_s", first_s, "time of the first; negative: before the drive", {.min = -600, .max = 1e6});
  f("every_s", every_s, "time from one to the next", {.min = 0.05, .max = 1e6});
  f("most", most, "in the hall at the same time", {.min = 1, .max = 500});
}

void ItemSink::visit(Fields& f) {
  f("x_m", x_m, "middle of the box in which items leave", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("y_m", y_m, "middle of the box", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("z_m", z_m, "middle of the box", {.min = -kHigh_m, .max = kHigh_m, .required = true});
  f("size_x_m", size_x_m, "size of the box", {.min = 0.01, .max = kFar_m});
  f("size_y_m", size_y_m, "size of the box", {.min = 0.01, .max = kFar_m});
  f("size_z_m", size_z_m, "size of the box", {.min = 0.01, .max = kHigh_m});
}

void ClutterConfig::visit(Fields& f) {
  f("name", name, "of its things; the file's stem where empty");
  body.visit(f);
  f("count", count, "how many are dropped", {.min = 1, .max = 500});
  f("x_m", x_m, "middle of the area", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("y_m", y_m, "middle of the area", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("z_m", z_m, "height from which the first falls, the others above it", {.min = 0, .max = kHigh_m});
  f("spread_x_m", spread_x_m, "half the length of the area", {.min = 0, .max = 100});
  f("spread_y_m", spread_y_m, "half the width of the area", {.min = 0, .max = 100});
  f("seed", seed, "of places and turns; the scenario's seed does not change them");
}

void WalkerConfig::visit(Fields& f) {
  f("name", name, "for messages; the file's stem where empty");
  visit_model_file(f, file, folder);
  f("speed_mps", speed_mps, "largest speed", {.min = 0.01, .max = 10});
  f("acceleration_mps2", acceleration_mps2, "largest acceleration and braking", {.min = 0.01, .max = 20});
  f("turn_rate_deg_s", turn_rate_deg_s, "largest rate of turn", {.min = 0.5, .max = 720});
  f("turn_acceleration_deg_s2", turn_acceleration_deg_s2, "largest change of the rate of turn", {.min = 0.5, .max = 7200});
  f("start_s", start_s, "stands at the first place until then", {.min = -3600, .max = 1e6});
  f("loop", loop, "goes back to the first place and round again");
  f.list("path", path, "places in order", {.required = true});
  if (path.empty()) f.reject("path", "has no place; expected at least one");
}

Pose HeldPlace::X_WG() const {
  Pose X = Pose::Identity();
  X.linear() = rotation_from_rpy(to_radians(roll_deg), to_radians(-tilt_deg), to_radians(yaw_deg));
  X.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return X;
}

void HeldPlace::visit(Fields& f) {
  f("x_m", x_m, "place of the model's origin in the world", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("y_m", y_m, "place of the model's origin in the world", {.min = -kFar_m, .max = kFar_m, .required = true});
  f("z_m", z_m, "height of the model's origin above the floor", {.min = -kHigh_m, .max = kHigh_m, .required = true});
  f("yaw_deg", yaw_deg, "world direction of the model's x axis", {.min = -360, .max = 360});
  f("tilt_deg", tilt_deg, "leans back: the x axis points up by this much", {.min = -90, .max = 90});
  f("roll_deg", roll_deg, "turned about the x axis", {.min = -180, .max = 180});
}

void HeldConfig::visit(Fields& f) {
  f("name", name, "for messages; the file's stem where empty");
  visit_model_file(f, file, folder);
  visit_optional_model(f, "stand", stand, folder, "glTF file of what holds it, upright, with the same origin; empty: none");
  f("hold_s", hold_s, "time in each place", {.min = 0, .max = 3600});
  f("move_s", move_s, "time from one place to the next", {.min = 0.01, .max = 3600});
  f.list("places", places, "in order", {.required = true});
  if (places.empty()) f.reject("places", "has no place; expected at least one");
}

void MotionConfig::set_folder(const std::filesystem::path& folder) {
  for (ItemStream& stream : streams) stream.body.folder = folder;
  for (ClutterConfig& thing : clutter) thing.body.folder = folder;
  for (WalkerConfig& walker : walkers) walker.folder = folder;
  for (HeldConfig& thing : held) thing.folder = folder;
}

void MotionConfig::visit(Fields& f) {
  f("step_hz", step_hz, "physics steps a second", {.min = 60, .max = 2000});
  f("settle_s", settle_s, "simulated before the drive, so that clutter lies still", {.min = 0, .max = 60});
  f.list("belts", belts, "conveyors that run");
  f.list("streams", streams, "parcels and totes that come in");
  f.list("sinks", sinks, "where they leave");
  f.list("clutter", clutter, "things dropped before the drive");
  f.list("walkers", walkers, "people and vehicles on their ways");
  f.list("held", held, "things that are held still in one place after the other");
}

}  // namespace waretwin
