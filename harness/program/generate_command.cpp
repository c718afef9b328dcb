// waretwin generate: a random hall.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "core/error.h"
#include "core/pose.h"
#include "harness/generate/hall_maker.h"
#include "harness/program/common_options.h"
#include "harness/program/interrupt.h"
#include "harness/program/progress.h"

namespace waretwin {

namespace {

struct GenerateOptions {
  CommonOptions common;
  std::string out, style = "cell", size;
  std::optional<int> conveyors;
  std::optional<double> coverage;
};

// "12x6": metres along x and y.
void take_size(const std::string& text, generate::GenerateConfig& config) {
  const char* const end = text.data() + text.size();
  const auto [middle, first] = std::from_chars(text.data(), end, config.length_m);
  bool good = first == std::errc() && middle != end && *middle == 'x';
  if (good) {
    const auto [last, second] = std::from_chars(middle + 1, end, config.width_m);
    good = second == std::errc() && last == end;
  }
  constexpr double kLargest = 200.0;
  const auto sound = [](double v) { return std::isfinite(v) && v > 0 && v <= kLargest; };
  if (!good || !sound(config.length_m) || !sound(config.width_m)) {
    throw Error("--size " + text + ": expected LENGTHxWIDTH of the floor in metres, each up to 200, e.g. 12x6");
  }
}

int generate_hall(const GenerateOptions& options) {
  options.common.apply();
  generate::GenerateConfig config;
  config.style = options.style;
  if (!options.size.empty()) take_size(options.size, config);
  if (options.conveyors) config.conveyors = *options.conveyors;
  if (options.coverage) config.coverage = *options.coverage;
  if (options.common.seed) config.seed = *options.common.seed;
  struct {
    generate::GenerateConfig& config;
    void visit(Fields& f) { f.group("generate", config, "a random hall"); }
  } tree{config};
  apply_settings(options.common.settings(), [&](Fields& f) { tree.visit(f); });

  MadeHall hall;
  {
    const InterruptWatch watch;
    Progress progress("generate", options.common.quiet);
    double draws = 0;
    hall = make_hall(config, options.out,
                     {[&] { watch.check("nothing was generated"); },
                      [&](const std::string& why) {
                        draws += 1;
                        progress.update(draws / (draws + 1), why);
                      }});
  }
  std::printf("%s: %g x %g x %g m, %zu %s, %d other things\n", hall.name.c_str(), hall.length_m, hall.width_m, hall.height_m,
              hall.objects.size(), hall.what.c_str(), hall.things);
  for (const MadeObject& c : hall.objects) {
    const Cuboid& box = c.object.cuboid;
    std::printf("  %2d %-18s %.2f x %.2f x %.2f m at (%6.2f, %6.2f, %.2f), yaw %5.1f deg; %d stops, %3.0f %% seen\n", c.object.id,
                c.kind.c_str(), box.size.x(), box.size.y(), box.size.z(), box.centre.x(), box.centre.y(), box.centre.z(),
                to_degrees(box.yaw), c.stops, 100 * c.coverage);
  }
  std::printf("route: %.1f m, %.0f s, %d stops; hall %d of the seed's draws\n", hall.route_m, hall.route_s, hall.stops, hall.draws);
  std::cout << "hall in " << options.out << " (waretwin run " << (std::filesystem::path(options.out) / "scenario.yaml").string()
            << " --out DIR); plan.png shows it from above\n";
  return 0;
}

}  // namespace

Command add_generate_command(CLI::App& program) {
  auto options = std::make_shared<GenerateOptions>();
  CLI::App* command =
      program.add_subcommand("generate", "a random hall with conveyors, or a furnished room, and a route that shows its objects");
  command->add_option("--out", options->out, "folder for scenario.yaml, hall.glb and plan.png; an earlier generated hall is replaced")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--style", options->style,
                   "cell: stations with clutter, like the AgiProbot's; warehouse: conveyor lines, racks, pallets; flat: a bare room, for "
                   "quick tests; home: a furnished room")
      ->capture_default_str()
      ->check(CLI::IsMember({"cell", "warehouse", "flat", "home"}));
  command->add_option("--size", options->size, "metres of floor along x and y, e.g. 12x6 (default: drawn)")->type_name("LxW");
  command->add_option("--conveyors", options->conveyors, "how many (default: drawn; a cell has 3 to 6; a home has none)")
      ->type_name("N")
      ->check(CLI::Range(1, 200));
  command
      ->add_option("--coverage", options->coverage,
                   "share of each object's viewable surface that depth views along the route must see (default 0.8; 0: any)")
      ->type_name("SHARE")
      ->check(number_from_to(0, 0.95));
  options->common.add_to(*command);
  command->get_option("--seed")->description("another hall; the same seed gives the same bytes (default 1)");
  command->footer(
      "Example:\n  waretwin generate --out halls/7 --seed 7\n  waretwin run halls/7/scenario.yaml --out out/7\n"
      "  waretwin generate --out halls/big --style warehouse --size 30x20 --conveyors 14\n"
      "  waretwin generate --out halls/home --style home --seed 3\n\n"
      "--set takes generate.clutter, generate.close_share, generate.clearance_m, generate.wait_s and the options' own keys.");
  return {command, [options] { return generate_hall(*options); }};
}

}  // namespace waretwin
