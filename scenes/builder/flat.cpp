#include "scenes/builder/halls.h"
#include "scenes/builder/parts/bags.h"
#include "scenes/builder/parts/beds_and_seats.h"
#include "scenes/builder/parts/books.h"
#include "scenes/builder/parts/fixtures.h"
#include "scenes/builder/parts/furniture.h"
#include "scenes/builder/parts/home_furniture.h"
#include "scenes/builder/parts/home_room.h"
#include "scenes/builder/parts/room.h"

namespace waretwin::builder {
namespace {

constexpr double kLength = 9.0, kWidth = 7.0, kHeight = 2.55;
constexpr double kX = kLength / 2, kY = kWidth / 2;
// Middles of the walls between rooms: living room and kitchen lie south of kNorth, the kitchen east of kEast and south of kSouth; study,
// bathroom and bedroom stand side by side in the north.
constexpr double kNorth = 0.7, kEast = 0.9, kSouth = -0.5, kStudy = -1.4, kHalf = kPartition / 2;

// One true object: a node of its own name, with whatever `add` puts into it.
template <class Add>
void add_object(Kit& kit, int parent, const std::string& name, const std::string& class_name, const Placement& at, const Add& add) {
  const int node = kit.group(name, parent, at);
  kit.model.set_class(node, class_name);
  add(node);
}

void add_shell(Kit& kit, int hall) {
  const int room = kit.group("rooms", hall);
  const auto area = [](double x0, double y0, double x1, double y1) { return Eigen::AlignedBox2d(Vector2d(x0, y0), Vector2d(x1, y1)); };
  add_floor_area(kit, room, "floor_south", area(-kX, -kY, kX, kSouth), "parquet_oak");
  add_floor_area(kit, room, "floor_hall", area(-kX, kSouth, kEast, kNorth), "parquet_oak");
  add_floor_area(kit, room, "floor_study", area(-kX, kNorth, kStudy, kY), "parquet_oak");
  add_floor_area(kit, room, "floor_bath", area(kStudy, kNorth, kEast, kY), "floor_tiles");
  add_floor_area(kit, room, "floor_bedroom", area(kEast, kSouth, kX, kY), "parquet_oak");
  add_ceiling_area(kit, room, "ceiling", area(-kX, -kY, kX, kY), kHeight);

  constexpr double kDoor = 2.05;
  add_wall(kit, room, "wall_south", {-kX, -kY, kX, -kY, kHeight, {{1.2, 0.9, 1.8, 1.3}, {6.2, 1.0, 1.2, 1.2}}, "wall_cream"});
  add_wall(kit, room, "wall_kitchen", {kX, -kY, kX, kSouth, kHeight, {}, "wall_cream"});
  add_wall(kit, room, "wall_bedroom_east", {kX, kSouth, kX, kY, kHeight, {}, "wall_blue"});
  add_wall(kit, room, "wall_bedroom_north", {kX, kY, kEast, kY, kHeight, {{1.6, 0.9, 1.4, 1.3}}, "wall_blue"});
  add_wall(kit, room, "wall_bath_north", {kEast, kY, kStudy, kY, kHeight, {}, "bath_tiles"});
  add_wall(kit, room, "wall_study_north", {kStudy, kY, -kX, kY, kHeight, {{1.0, 0.95, 1.4, 1.2}}, "wall_sage"});
  add_wall(kit, room, "wall_study_west", {-kX, kY, -kX, kNorth, kHeight, {}, "wall_sage"});
  add_wall(kit, room, "wall_west", {-kX, kNorth, -kX, -kY, kHeight, {{0.2, 0, 0.95, kDoor}}, "wall_cream"});
  add_window(kit, room, {-2.4, -kY, 0.9, 0}, 1.8, 1.3);
  add_window(kit, room, {2.3, -kY, 1.0, 0}, 1.2, 1.2);
  add_window(kit, room, {2.2, kY, 0.9, 180}, 1.4, 1.3);
  add_window(kit, room, {-3.1, kY, 0.95, 180}, 1.4, 1.2);
  add_door(kit, room, {-kX, kNorth - 0.675, 0, -90}, 0.95, kDoor);

  add_partition(kit, room, "partition_study", {-kX, kNorth, kStudy, kNorth, kHeight, {{2.0, 0, 0.9, kDoor}}, "wall_sage", "wall_cream"});
  add_partition(kit, room, "partition_bath",
                {kStudy, kNorth, kEast, kNorth, kHeight, {{0.55, 0, 0.85, kDoor}}, "bath_tiles", "wall_cream"});
  add_partition(kit, room, "partition_between", {kStudy, kNorth, kStudy, kY, kHeight, {}, "wall_sage", "bath_tiles"});
  add_partition(kit, room, "partition_bedroom",
                {kEast, kSouth - kHalf, kEast, kNorth, kHeight, {{0.20, 0, 0.90, kDoor}}, "wall_cream", "wall_blue"});
  add_partition(kit, room, "partition_tub", {kEast, kNorth, kEast, kY, kHeight, {}, "bath_tiles", "wall_blue"});
  add_partition(kit, room, "partition_kitchen", {kEast - kHalf, kSouth, kX, kSouth, kHeight, {}, "wall_blue", "wall_cream"});

  for (const Placement& lamp : {Placement{-2.6, -1.5, kHeight}, Placement{-0.4, -0.4, kHeight}, Placement{2.3, -1.9, kHeight},
                                Placement{2.4, 1.6, kHeight}, Placement{-0.25, 2.0, kHeight}, Placement{-2.9, 2.0, kHeight}})
    add_round_lamp(kit, room, lamp, 9.0);
}

void add_living_room(Kit& kit, int hall) {
  const int room = kit.group("living_room", hall);
  add_carpet(kit, room, {-2.4, -1.75, 0, 0.8}, 2.0, 1.4, "carpet_red");
  add_object(kit, room, "sofa", "sofa", {-2.4, -2.98, 0, 180.4}, [&](int at) { add_sofa(kit, at, {}, {.width = 2.05}); });
  add_object(kit, room, "armchair", "sofa", {-0.55, -2.2, 0, -96.3}, [&](int at) {
    add_sofa(kit, at, {}, {.width = 0.92, .depth = 0.88, .height = 0.84, .seats = 1, .fabric = "fabric_green", .cushion = "linen_white"});
  });
  add_object(kit, room, "low_table", "table", {-2.4, -1.72, kCarpet, 2.4}, [&](int at) {
    add_wooden_table(kit, at, {}, {.width = 1.05, .depth = 0.58, .height = 0.42, .wood = "walnut", .shelf = true});
  });
  add_object(kit, room, "books_low_table", "books", {-2.66, -1.70, 0.42 + kCarpet, 17.3},
             [&](int at) { add_book_pile(kit, at, {}, 5, "living"); });
  add_cup(kit, room, {-2.2, -1.83, 0.42 + kCarpet, 60});
  add_chest(kit, room, {-4.26, -2.1, 0, 90},
            {.width = 1.6, .depth = 0.42, .height = 0.46, .columns = 3, .rows = 1, .body = "walnut", .front = "white_lacquer"});
  add_object(kit, room, "television", "television", {-4.27, -2.1, 0.46, 90.7}, [&](int at) { add_television(kit, at, {}, 1.15); });
  add_floor_lamp(kit, room, {-3.85, -3.15});
  add_plant(kit, room, {0.1, -2.98, 0, 30});
  add_curtains(kit, room, {-2.4, -kY, 2.32, 0}, 1.8, 1.45);
  add_chest(kit, room, {-3.25, 0.47, 0, 0.0},
            {.width = 0.8, .depth = 0.32, .height = 0.88, .columns = 1, .rows = 3, .body = "oak", .front = "white_lacquer"});
  add_wall_picture(kit, room, {-3.25, kNorth - kHalf, 1.35, 180}, 0.72, 0.54, "painting_hills");
  add_object(kit, room, "shopping_bag", "bag", {-4.02, 0.36, 0, 11.4}, [&](int at) { add_shopping_bag(kit, at, {}); });
  add_wall_picture(kit, room, {-kX, -2.9, 1.3, -90}, 0.48, 0.64, "painting_shapes");
}

void add_kitchen(Kit& kit, int hall) {
  const int room = kit.group("kitchen", hall);
  add_object(kit, room, "refrigerator", "refrigerator", {4.16, -0.92, 0, -90.6}, [&](int at) { add_refrigerator(kit, at, {}, {}); });
  add_counter(kit, room, {4.175, -2.37, 0, -90}, {.length = 2.2});
  add_wall_tiles(kit, room, {kX, -2.37, 0.9, 90}, 2.2, 0.55, "kitchen_tiles");
  add_wall_cupboards(kit, room, {kX - 0.175, -2.37, 1.45, -90}, 2.2);
  add_pot(kit, room, {4.29, -2.89, 0.9068, 20});
  add_cup(kit, room, {4.3, -2.25, 0.9, 100});
  add_object(kit, room, "dining_table", "table", {2.2, -2.28, 0, 0.7}, [&](int at) { add_wooden_table(kit, at, {}, {}); });
  add_fruit_bowl(kit, room, {2.15, -2.3, 0.74, 10});
  const Placement chairs[] = {{1.87, -1.72, 0, 4.6}, {2.56, -1.64, 0, -8.4}, {1.84, -2.91, 0, 176.3}, {2.58, -3.04, 0, 188.7}};
  for (int i = 0; i < 4; ++i) {
    add_object(kit, room, "chair_" + std::to_string(i + 1), "chair", chairs[i],
               [&](int at) { add_wooden_chair(kit, at, {}, {.cushion = i % 2 == 0 ? "fabric_rust" : ""}); });
  }
}

void add_bedroom(Kit& kit, int hall) {
  const int room = kit.group("bedroom", hall);
  add_object(kit, room, "bed", "bed", {3.44, 1.75, 0, -90.4}, [&](int at) { add_bed(kit, at, {}, {}); });
  for (const double y : {0.62, 2.9}) add_chest(kit, room, {4.26, y, 0, -90}, {});
  add_table_lamp(kit, room, {4.3, 2.9, 0.5});
  add_object(kit, room, "books_bedside", "books", {4.22, 0.62, 0.5, -74.0}, [&](int at) { add_book_pile(kit, at, {}, 3, "bedside"); });
  add_wardrobe(kit, room, {3.52, kSouth + kHalf + 0.31, 0, 180}, {});
  add_chest(kit, room, {1.19, 1.45, 0, 90},
            {.width = 0.9, .depth = 0.42, .height = 0.84, .columns = 2, .rows = 3, .body = "pine", .front = "pine"});
  add_vase(kit, room, {1.17, 1.65, 0.84});
  add_object(kit, room, "chair_5", "chair", {1.32, 3.02, 0, 28.6},
             [&](int at) { add_wooden_chair(kit, at, {}, {.wood = "pine", .cushion = "fabric_beige"}); });
  add_object(kit, room, "backpack", "bag", {1.15, 2.3, 0, 84.2}, [&](int at) { add_backpack(kit, at, {}, "canvas_red"); });
  add_curtains(kit, room, {2.2, kY, 2.32, 180}, 1.4, 2.2);
  add_wall_picture(kit, room, {kX, 1.75, 1.4, 90}, 0.8, 0.6, "painting_hills");
}

void add_bathroom(Kit& kit, int hall) {
  const int room = kit.group("bathroom", hall);
  add_object(kit, room, "toilet", "toilet", {-0.72, 3.14, 0, 0.5}, [&](int at) { add_toilet(kit, at, {}); });
  add_bathtub(kit, room, {kEast - kHalf - 0.355, 2.68, 0, 90}, 1.6, 0.7);
  add_washbasin(kit, room, {kStudy + kHalf + 0.225, 1.75, 0, 90});
  add_carpet(kit, room, {-0.2, 2.35, 0, 90}, 0.8, 0.5, "bath_mat");
  add_waste_bin(kit, room, {0.62, 1.62});
}

void add_study(Kit& kit, int hall) {
  const int room = kit.group("study", hall);
  add_object(kit, room, "desk", "table", {-3.1, 3.12, 0, -0.6},
             [&](int at) { add_wooden_table(kit, at, {}, {.width = 1.5, .depth = 0.7, .drawers = true}); });
  add_monitor(kit, room, {-3.05, 3.24, 0.74, -6}, "screen_code");
  add_keyboard(kit, room, {-3.12, 2.97, 0.74, -3});
  add_object(kit, room, "books_desk", "books", {-3.62, 3.08, 0.74, 24.3}, [&](int at) { add_book_pile(kit, at, {}, 6, "desk"); });
  add_object(kit, room, "office_chair", "chair", {-3.0, 2.3, 0, 157.4}, [&](int at) { add_office_chair(kit, at, {}, "fabric_blue"); });
  const Bookcase shelf{.width = 1.2, .height = 1.06};
  const Placement shelf_at{-kX + 0.155, 1.75, 0, 90};
  add_bookcase(kit, room, shelf_at, shelf);
  // Rows on its boards stand a little behind its front, in its own frame at y = -0.03.
  struct Row {
    int board;
    double along, length;
  };
  for (const Row& row : {Row{1, -0.05, 1.02}, Row{2, 0.14, 0.84}, Row{3, -0.06, 0.62}}) {
    const std::string key = "shelf_" + std::to_string(row.board);
    add_object(kit, room, "books_" + key, "books", {shelf_at.x + 0.03, shelf_at.y + row.along, shelf.board_top(row.board), 90},
               [&](int at) { add_book_row(kit, at, {}, row.length, 0.28, key); });
  }
  for (const double along : {-0.3, 0.3})
    add_bin(kit, room, {shelf_at.x + 0.02, shelf_at.y + along, shelf.board_top(0), 90}, 0.44, 0.24, 0.2, "grey_plastic");
  add_object(kit, room, "handbag", "bag", {-1.85, 3.15, 0, -24.6}, [&](int at) { add_handbag(kit, at, {}, "leather_brown"); });
  add_curtains(kit, room, {-3.1, kY, 2.32, 180}, 1.4, 1.4);
  add_wall_picture(kit, room, {kStudy - kHalf, 1.9, 1.3, 90}, 0.48, 0.64, "painting_shapes");
}

}  // namespace

void build_flat(Kit& kit) {
  // Rooms that people live in: skirtings and doors of wood, not of metal.
  kit.define("skirting", [] { return make_finish("white_lacquer"); });
  kit.define("door_paint", [] { return make_finish("pine"); });
  const int hall = kit.group("flat", -1);
  add_shell(kit, hall);
  add_living_room(kit, hall);
  add_kitchen(kit, hall);
  add_bedroom(kit, hall);
  add_bathroom(kit, hall);
  add_study(kit, hall);
}

}  // namespace waretwin::builder
