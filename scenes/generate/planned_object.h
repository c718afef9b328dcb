// A true object of a plan, a conveyor or a piece of furniture: what is built, what it fills, and what of it a camera should see.
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "scenes/builder/parts/conveyors.h"
#include "scenes/generate/solid.h"

namespace waretwin::generate {

// Anything else that counts: how it is built in its own frame, and its box there. Cameras see a box.
struct FurniturePart {
  std::string class_name;
  std::string kind;  // "wooden chair": for people
  std::function<void(builder::Kit& kit, int parent)> add;
  Eigen::AlignedBox3d extent;
};
using ObjectPart = std::variant<builder::TableTopConveyor, builder::FloorConveyor, builder::CurveConveyor, FurniturePart>;

// A patch of the outer surface, roughly: cameras see the real triangles, plans these.
struct SurfacePatch {
  Eigen::Vector3d p_W, normal;
  double area = 0.0;  // square metres
};

struct PlannedObject {
  std::string name;
  ObjectPart part;
  builder::Placement at;

  std::string kind() const;                   // "table-top belt", "floor rollers", "wooden chair" ...
  std::vector<Solid> solids() const;          // what it fills; a curve in pieces
  std::vector<Solid> decks() const;           // what of it hides things: a floor-standing one lets light through between its legs
  std::vector<SurfacePatch> surface() const;  // top, sides and legs
  Eigen::Vector3d middle() const;             // of its box
};

// In the part's own frame.
Eigen::AlignedBox3d extent_of(const ObjectPart& part);

int add_planned_object(builder::Kit& kit, int parent, const PlannedObject& object);

}  // namespace waretwin::generate
