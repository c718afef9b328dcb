// A conveyor of a plan: what is built, what it fills, and what of it a camera should see.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "scenes/builder/parts/conveyors.h"
#include "scenes/generate/solid.h"

namespace waretwin::generate {

using ConveyorPart = std::variant<builder::TableTopConveyor, builder::FloorConveyor, builder::CurveConveyor>;

// A patch of the outer surface, roughly: cameras see the real triangles, plans these.
struct SurfacePatch {
  Eigen::Vector3d p_W, normal;
  double area = 0.0;  // square metres
};

struct PlannedConveyor {
  std::string name;
  ConveyorPart part;
  builder::Placement at;

  std::string kind() const;                   // "table-top belt", "floor rollers", "curve belt" ...
  std::vector<Solid> solids() const;          // what it fills; a curve in pieces
  std::vector<Solid> decks() const;           // what of it hides things: a floor-standing one lets light through between its legs
  std::vector<SurfacePatch> surface() const;  // top, sides and legs
  Eigen::Vector3d middle() const;             // of its box
};

// In the part's own frame.
Eigen::AlignedBox3d extent_of(const ConveyorPart& part);

int add_conveyor(builder::Kit& kit, int parent, const PlannedConveyor& conveyor);

}  // namespace waretwin::generate
