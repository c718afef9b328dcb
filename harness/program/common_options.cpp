#include "harness/program/common_options.h"

#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <sstream>

#include "core/parallel.h"

namespace waretwin {

CLI::Validator number_from_to(double least, double most) {
  return {[=](const std::string& text) {
            double value = 0.0;
            const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool good = status == std::errc() && end == text.data() + text.size() && value >= least && value <= most;
            std::ostringstream problem;
            if (!good) problem << "is " << text << "; expected a number from " << least << " to " << most;
            return problem.str();
          },
          ""};
}

CLI::Validator whole_number() {
  return {[](const std::string& text) {
            std::uint64_t value = 0;
            const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool good = status == std::errc() && end == text.data() + text.size();
            return good ? std::string() : "is " + text + "; expected a whole number of at least 0";
          },
          ""};
}

void CommonOptions::add_to(CLI::App& command) {
  command.add_option("--seed", seed, "reseeds all sensors and the motion, never the hall")->type_name("N")->check(whole_number());
  command.add_option("--threads", threads, "limits the threads; results never depend on it (0: all cores)")
      ->type_name("N")
      ->check(CLI::Range(0, 4096));
  command.add_option("--set", set, "a configuration key, e.g. mapper.integrate.voxel_m=0.03; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_flag("--quiet", quiet, "only errors on stderr");
}

void CommonOptions::apply() const {
  set_thread_count(threads);
  spdlog::set_level(quiet ? spdlog::level::err : spdlog::level::info);
}

std::vector<Setting> CommonOptions::settings() const {
  std::vector<Setting> settings;
  for (const std::string& text : set) settings.push_back(parse_setting(text));
  return settings;
}

}  // namespace waretwin
