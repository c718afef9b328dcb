// What moves in a hall beside the robot: belts and what they carry, clutter that was dropped, people and vehicles on their ways, boards
// that are held up. Keys of a scenario under `motion`. sim/motion/ moves it; this room only says what there is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/fields.h"
#include "core/pose.h"
#include "scenes/waypoint.h"

namespace waretwin {

// From `at_s` on the belt is to run at this speed.
struct BeltChange {
  double at_s = 0.0;
  double speed_mps = 0.0;
  void visit(Fields& f);
};

// Objects of the hall whose running surface carries what lies on it. Its height, its width and what stands beside it are read from the
// object's triangles (sim/motion/belt_surface.h).
struct BeltConfig {
  std::string object;  // names of objects; * and ? as in `truth`
  double speed_mps = 0.3;
  double heading_deg =
      0.0;  // world direction of travel of straight belts; they run along their longer or shorter side, whichever is nearer
  // A curve turns about this vertical axis instead, counter-clockwise where its speed is positive; the speed is that of its centre line.
  bool curve = false;
  double pivot_x_m = 0.0, pivot_y_m = 0.0;
  double acceleration_mps2 = 1.0;  // of start and stop
  double friction = 0.7;           // Coulomb, with what lies on it
  std::vector<BeltChange> changes;
  void visit(Fields& f);
};

// What a loose thing is. It collides as the box of its triangles.
struct ItemBody {
  std::filesystem::path file;    // .gltf or .glb beside the scenario
  std::filesystem::path folder;  // of the scenario; when set, the file must exist (visit_model_file); not a key
  double mass_kg = 4.0;
  double friction = 0.6;
  void visit(Fields& f);
};

// Parcels or totes that come into the hall one after the other, as from an infeed: the model's origin at (x, y, z), once that place is
// free.
struct ItemStream {
  std::string name;
  ItemBody body;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_deg = 0.0;
  double yaw_spread_deg = 5.0, side_spread_m = 0.02;  // drawn for each item, uniform in +-, from the scenario's seed
  double first_s = 0.0;                               // negative: before the drive, which begins at 0
  double every_s = 5.0;
  int most = 10;  // in the hall at the same time; the next one waits until another has left
  void visit(Fields& f);
};

// Where items leave the hall: any whose middle lies in this upright box.
struct ItemSink {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;  // its middle
  double size_x_m = 0.5, size_y_m = 0.5, size_z_m = 0.5;
  void visit(Fields& f);
};

// Things dropped before the drive, each turned at random, which lie as they fell. The scenario's seed does not change them.
struct ClutterConfig {
  std::string name;
  ItemBody body;
  int count = 1;
  double x_m = 0.0, y_m = 0.0, z_m = 0.5;     // middle of the area, height of the lowest's origin
  double spread_x_m = 0.2, spread_y_m = 0.2;  // half the area
  std::uint64_t seed = 1;
  void visit(Fields& f);
};

// Somebody or something that goes its way whatever stands there: turns in place, goes straight, waits.
struct WalkerConfig {
  std::string name;
  std::filesystem::path file;    // origin on the floor; forward is the model's x axis
  std::filesystem::path folder;  // of the scenario; see ItemBody
  double speed_mps = 1.2, acceleration_mps2 = 1.5;
  double turn_rate_deg_s = 180.0, turn_acceleration_deg_s2 = 720.0;
  double start_s = 0.0;  // stands at the first place until then
  bool loop = true;      // back to the first place and round again
  std::vector<Waypoint> path;
  void visit(Fields& f);
};

// How a held thing is turned where it is shown.
struct HeldPlace {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;  // of the model's origin
  double yaw_deg = 0.0;                    // world direction of the model's x axis
  double tilt_deg = 0.0;                   // then backwards, so that the x axis points up by this much
  double roll_deg = 0.0;                   // then about its x axis
  Pose X_WG() const;                       // R = Rz(yaw) * Ry(-tilt) * Rx(roll)
  void visit(Fields& f);
};

// Something that is set up in one place after the other and held still in each: a calibration board. It is carried evenly from place to
// place, stays in the last one, and stands in nobody's way.
struct HeldConfig {
  std::string name;
  std::filesystem::path file;    // origin where it is held
  std::filesystem::path stand;   // what holds it, with the same origin: goes along upright, turned by yaw alone; empty: none
  std::filesystem::path folder;  // of the scenario; see ItemBody
  double hold_s = 2.0, move_s = 0.5;
  std::vector<HeldPlace> places;
  void visit(Fields& f);
};

struct MotionConfig {
  double step_hz = 240.0;  // physics steps a second
  double settle_s = 2.0;   // simulated before the drive, so that clutter lies still
  std::vector<BeltConfig> belts;
  std::vector<ItemStream> streams;
  std::vector<ItemSink> sinks;
  std::vector<ClutterConfig> clutter;
  std::vector<WalkerConfig> walkers;
  std::vector<HeldConfig> held;

  bool empty() const { return belts.empty() && streams.empty() && clutter.empty() && walkers.empty() && held.empty(); }
  // All files are looked for here; see ItemBody::folder.
  void set_folder(const std::filesystem::path& folder);
  void visit(Fields& f);
};

}  // namespace waretwin
