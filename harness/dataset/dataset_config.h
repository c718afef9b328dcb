// What a set of training pictures is made of. Keys under `dataset` of `waretwin dataset --set`; written resolved to dataset.yaml.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/fields.h"
#include "harness/truth/label_rule.h"
#include "sim/render_options.h"

namespace waretwin {

// Where pictures are taken from, as shares of all; the rest looks at objects from anywhere around them.
struct ViewConfig {
  double route_share = 0.4;  // from the vehicle's mount along the route
  double empty_share = 0.1;  // without any object, on purpose
  // Around objects: the camera's distance from the object's middle, and its height.
  double distance_min_m = 0.8, distance_max_m = 5.0;
  double height_min_m = 0.5, height_max_m = 2.0;
  double roll_deg = 3.0;       // +-
  double least_share = 0.004;  // of the picture that the object must fill for the view to be taken
  double speed_mps = 0.5;      // up to this the camera moves during the exposure
  double turn_rate_deg_s = 20.0;
  void visit(Fields& f);
};

// The camera of a hall's pictures: the scenario's own, each value drawn anew for each hall.
struct CameraVariation {
  std::string name;             // which of the scenario's cameras; empty: the first
  double field_share = 0.1;     // of both fields of view, +-
  double height_m = 0.15;       // of the mount, +-
  double place_m = 0.1;         // of the mount, forwards and sideways, +-
  double pitch_deg = 8.0;       // +-
  double yaw_deg = 5.0;         // +-
  double exposure_stops = 0.7;  // brightness of the picture, +-
  double noise_stops = 1.0;     // sensitivity of the sensor, +-: fewer electrons, more noise
  void visit(Fields& f);
};

struct LightVariation {
  double strength_stops = 0.7;  // of each lamp, +-
  double ambient_stops = 0.5;   // +-
  double tint = 0.12;           // of each lamp's red and blue, +-
  double off_share = 0.15;      // of the lamps; one stays on
  void visit(Fields& f);
};

struct MaterialVariation {
  double tint_share = 0.5;      // of the materials whose colour is shifted
  double tint = 0.25;           // by how much of the range, +-
  double repaint_share = 0.1;   // of the materials that get another colour altogether
  double pattern_share = 0.08;  // of the materials that get a drawn pattern
  double dirt_share = 0.3;      // of the materials that get stains
  double roughness = 0.2;       // +-
  void visit(Fields& f);
};

// What is put into the hall beside its own things. Nothing of it is an object.
struct ThingsVariation {
  int loose_max = 10;    // boxes, cans, bars dropped about, which lie as they fell
  int parcels_max = 4;   // the same on top of objects
  int standing_max = 4;  // frames, tables, stacks, columns that look like machines from afar
  void visit(Fields& f);
};

struct DatasetConfig {
  std::uint64_t seed = 1;
  int count = 100;                             // pictures
  int images_per_hall = 0;                     // with one hall, light, set of materials and things; 0: see hall_size()
  double valid_share = 0.1, test_share = 0.1;  // of the halls
  int jpeg_quality = 92;
  bool depth = false;      // also true depth, 16-bit PNG in millimetres
  bool instances = false;  // also instance images, 16-bit PNG
  double polygon_tolerance_px = 1.0;
  std::vector<std::string> classes = {};  // kept, in this order; empty: all that the halls have, by name
  LabelRule labels;                       // which objects get one; what is left out is counted
  ViewConfig views;
  CameraVariation camera;
  LightVariation light;
  MaterialVariation materials;
  ThingsVariation things;
  RenderOptions render;
  std::string isa = "avx2";

  // Pictures of one hall. Unless it is set, as many as make at least four hundred halls, at most 10: small sets live on variety, and in
  // large ones a new hall must not cost more than its pictures.
  int hall_size() const;
  void visit(Fields& f);
};

}  // namespace waretwin
