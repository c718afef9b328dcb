#include "harness/generate/drawn_hall.h"

#include "core/config.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/process_name.h"
#include "harness/generate/hall_maker.h"
#include "harness/units/units.h"

namespace waretwin {

namespace fs = std::filesystem;

bool DrawnHall::changed() const {
  const auto text = [](generate::GenerateConfig hall) { return write_config([&](Fields& f) { hall.visit(f); }); };
  return text(config) != text(DrawnHall().config);
}

void check_hall_source(Fields& f, const std::string& scenario, const DrawnHall& drawn) {
  if (!drawn.asked_for() && drawn.changed()) f.reject("generate", "has no style; expected one");
  if (scenario.empty() && !drawn.asked_for()) f.reject("scenario", "missing; expected a scenario file, or generate with a style");
  if (!scenario.empty() && drawn.asked_for()) f.reject("scenario", "and generate are both named; expected one of them");
}

fs::path draw_hall_once(generate::GenerateConfig config, const fs::path& out, const std::function<void()>& check) {
  Digest digest;
  digest.add(program_identity());
  digest.add(write_config([&](Fields& f) { config.visit(f); }));
  const fs::path hall = out / "halls" / digest.hex();
  if (fs::exists(hall)) return hall;
  // Another process may draw it, too: whoever is first has made it for both.
  fs::path own = hall;
  own += "-" + process_name();
  make_hall(config, own, {.step = check, .in_vain = {}});
  std::error_code taken, ignored;
  fs::rename(own, hall, taken);
  if (taken) fs::remove_all(own, ignored);
  if (!fs::exists(hall)) throw Error(hall, "cannot be put in place: " + taken.message());
  return hall;
}

}  // namespace waretwin
