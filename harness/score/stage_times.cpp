#include "harness/score/stage_times.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

#include "core/error.h"
#include "core/files.h"

namespace waretwin {

namespace {

struct Column {
  const char* name;
  double StageTimes::*member;
};

constexpr std::array<Column, 5> kColumns = {{{"localise_ms", &StageTimes::localise},
                                             {"detect_ms", &StageTimes::detect},
                                             {"segment_ms", &StageTimes::segment},
                                             {"associate_ms", &StageTimes::associate},
                                             {"integrate_ms", &StageTimes::integrate}}};

std::vector<std::string> cells_of(std::string line) {
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

double time_of(const std::string& cell, const std::filesystem::path& file, int line) {
  double value = 0.0;
  const auto [end, status] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (status != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value) || value < 0.0) {
    throw Error(file, line, "'" + cell.substr(0, 40) + "'; expected milliseconds");
  }
  return value;
}

}  // namespace

std::optional<StageTimes> read_stage_times(const std::filesystem::path& timing_csv) {
  std::istringstream text(read_file(timing_csv));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> head = cells_of(line);
  std::array<std::size_t, kColumns.size()> places{};
  for (std::size_t k = 0; k < kColumns.size(); ++k) {
    const auto found = std::find(head.begin(), head.end(), kColumns[k].name);
    if (found == head.end()) throw Error(timing_csv, 1, "has no column " + std::string(kColumns[k].name));
    places[k] = static_cast<std::size_t>(found - head.begin());
  }
  StageTimes times;
  for (int number = 2; std::getline(text, line); ++number) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != head.size()) {
      throw Error(timing_csv, number, "has " + std::to_string(cells.size()) + " columns; expected " + std::to_string(head.size()));
    }
    for (std::size_t k = 0; k < kColumns.size(); ++k) times.*kColumns[k].member += time_of(cells[places[k]], timing_csv, number);
    ++times.frames;
  }
  if (times.frames == 0) return std::nullopt;
  for (const Column& column : kColumns) times.*column.member /= times.frames;
  return times;
}

std::optional<StageTimes> mean_times(const std::vector<StageTimes>& sequences) {
  if (sequences.empty()) return std::nullopt;
  StageTimes mean;
  for (const StageTimes& times : sequences) {
    mean.frames += times.frames;
    for (const Column& column : kColumns) mean.*column.member += times.*column.member / static_cast<double>(sequences.size());
  }
  return mean;
}

}  // namespace waretwin
