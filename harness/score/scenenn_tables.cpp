#include <algorithm>
#include <functional>
#include <set>

#include "harness/gate/markdown_table.h"
#include "harness/score/number_text.h"
#include "harness/score/scenenn_paper.h"
#include "harness/score/scenenn_report.h"

namespace waretwin {

namespace {

using Row = std::vector<std::string>;
using Rows = std::vector<Row>;
using Value = std::optional<double>;

constexpr const char* kPaper = "Zhou et al.";
constexpr const char* kOurs = "waretwin";
constexpr const char* kOursPaper = "waretwin, TP / (TP + FP)";
constexpr const char* kOursArea = "waretwin, AP";

std::string percent(const Value& fraction) { return number("%.1f", fraction ? Value(100.0 * *fraction) : fraction); }

// Names come from files and folders; a bar or a line break in one would break the table.
std::string cell(const std::string& name) {
  std::string text;
  for (const char c : name) text += c == '|' ? "\\|" : static_cast<unsigned char>(c) < ' ' ? " " : std::string(1, c);
  return text;
}

// Classes that stand in a truth of ours and have no column in the paper.
std::vector<std::string> other_classes(const SceneNnScore& score) {
  std::vector<std::string> names;
  for (const ClassMean& one : score.classes) {
    if (std::find(kSceneNnClasses.begin(), kSceneNnClasses.end(), one.class_name) == kSceneNnClasses.end()) names.push_back(one.class_name);
  }
  return names;
}

// The columns of Tables 1 and 2: the paper's classes, then ours.
class ClassColumns {
 public:
  explicit ClassColumns(const SceneNnScore& score) : others_(other_classes(score)) {}

  void add_heads(Row& row) const {
    for (const std::string name : kSceneNnClasses) row.push_back(static_cast<char>(name[0] - 'a' + 'A') + name.substr(1));
    for (const std::string& name : others_) row.push_back(cell(name));
  }
  void add_published(Row& row, const PaperSequence& published) const {
    for (const Value& value : published.classes) row.push_back(number("%.1f", value));
    row.insert(row.end(), others_.size(), "-");
  }
  // By a figure of a class, given its name.
  void add(Row& row, const std::function<Value(const std::string&)>& figure) const {
    for (const char* name : kSceneNnClasses) row.push_back(percent(figure(name)));
    for (const std::string& name : others_) row.push_back(percent(figure(name)));
  }

 private:
  std::vector<std::string> others_;
};

// Of a list of figures by class (ClassScore, ClassMean) the one of that class.
template <class T, class Member>
std::function<Value(const std::string&)> figure_of(const std::vector<T>& classes, Member member) {
  return [&classes, member](const std::string& name) -> Value {
    const auto found = std::find_if(classes.begin(), classes.end(), [&](const T& one) { return one.class_name == name; });
    return found == classes.end() ? Value() : Value(*found.*member);
  };
}

constexpr const char* kMeanName = "mean";

std::string table1(const SceneNnScore& score, const ClassColumns& columns) {
  Rows rows = {{"Source", "Sequence"}};
  columns.add_heads(rows[0]);
  rows[0].insert(rows[0].end(), {"Avg.", "Avg. of found"});
  for (const PaperSequence& published : paper_table1()) {
    Row& row = rows.emplace_back(Row{kPaper, published.id});
    columns.add_published(row, published);
    row.insert(row.end(), {number("%.1f", published.average), "-"});
  }
  for (const SequenceScore& one : score.sequences) {
    Row& row = rows.emplace_back(Row{kOurs, cell(one.name)});
    columns.add(row, figure_of(one.classes, &ClassScore::mean_iou3d));
    row.insert(row.end(), {percent(one.mean_iou3d), percent(one.mean_iou3d_found)});
  }
  Row& row = rows.emplace_back(Row{kOurs, kMeanName});
  columns.add(row, figure_of(score.classes, &ClassMean::mean_iou3d));
  row.insert(row.end(), {percent(score.mean_iou3d), "-"});
  return "\n## Table 1: 3D IoU (%)\n\n" + markdown_table(rows, 2) +
         "\nA dash: the sequence has no such object that counts; 0: it has one, and nothing was found. Avg. is over the classes of a row, "
         "zeros "
         "included; "
         "the paper's own\naverages are as printed (docs/metrics.md says which of them follow from their rows). mean: of each class over "
         "the "
         "sequences that have it, and of Avg.\n";
}

std::string table2(const SceneNnScore& score, const ClassColumns& columns) {
  Rows rows = {{"Source", "Sequence"}};
  columns.add_heads(rows[0]);
  rows[0].insert(rows[0].end(), {"Avg.", "Avg. (Voxblox++)"});
  for (const PaperSequence& published : paper_table2()) {
    Row& row = rows.emplace_back(Row{kPaper, published.id});
    columns.add_published(row, published);
    row.insert(row.end(), {number("%.1f", published.average), number("%.1f", published.average_voxbloxpp)});
  }
  const auto add = [&](const char* source, const std::string& name, const std::function<Value(const std::string&)>& figure,
                       const Value& average) {
    Row& row = rows.emplace_back(Row{source, cell(name)});
    columns.add(row, figure);
    row.insert(row.end(), {percent(average), "-"});
  };
  for (const SequenceScore& one : score.sequences) {
    add(kOursPaper, one.name, figure_of(one.classes, &ClassScore::ap_paper), one.map_paper);
    add(kOursArea, one.name, figure_of(one.classes, &ClassScore::ap50), one.ap50);
  }
  add(kOursPaper, kMeanName, figure_of(score.classes, &ClassMean::ap_paper), score.map_paper);
  add(kOursArea, kMeanName, figure_of(score.classes, &ClassMean::ap50), score.ap50);
  return "\n## Table 2: average precision at IoU " + number("%g", score.rules.match_iou) + " (%)\n\n" + markdown_table(rows, 2) +
         "\nTP / (TP + FP) is how the paper counts; AP is the area under the precision-recall curve, which counts what was missed, too.\n";
}

std::string table3(const SceneNnScore& score) {
  std::set<std::string> ours, scored;
  for (const SequenceScore& one : score.sequences) {
    ours.insert(one.name);
    if (one.map_paper) scored.insert(one.name);
  }
  std::vector<std::string> names(kSceneNnSequences.begin(), kSceneNnSequences.end());
  const auto in_paper = [&](const std::string& name) {
    return std::find(kSceneNnSequences.begin(), kSceneNnSequences.end(), name) != kSceneNnSequences.end();
  };
  std::vector<bool> shared;
  for (const std::string& name : names) shared.push_back(scored.contains(name));
  const auto count = std::count(shared.begin(), shared.end(), true);
  for (const std::string& name : ours) {
    if (!in_paper(name)) names.push_back(name);
  }

  Rows rows = {{"Method"}};
  for (const std::string& name : names) rows[0].push_back(cell(name));
  rows[0].insert(rows[0].end(), {"Average", "Avg. of shared"});
  for (const PaperMethod& method : paper_table3()) {
    Row& row = rows.emplace_back(Row{method.name});
    double sum = 0.0;
    for (std::size_t i = 0; i < method.sequences.size(); ++i) {
      row.push_back(number("%.1f", method.sequences[i]));
      if (shared[i]) sum += method.sequences[i];
    }
    row.insert(row.end(), names.size() - method.sequences.size(), "-");
    row.push_back(number("%.1f", method.average));
    row.push_back(number("%.1f", count > 0 ? Value(sum / static_cast<double>(count)) : Value()));
  }
  const auto add = [&](const char* source, Value SequenceScore::*member, const Value& average) {
    Row& row = rows.emplace_back(Row{source});
    double sum = 0.0;
    int summed = 0;
    for (const std::string& name : names) {
      const auto found = std::find_if(score.sequences.begin(), score.sequences.end(), [&](const auto& one) { return one.name == name; });
      const Value value = found == score.sequences.end() ? Value() : (*found).*member;
      row.push_back(percent(value));
      if (!value || !in_paper(name)) continue;
      sum += *value;
      ++summed;
    }
    row.push_back(percent(average));
    row.push_back(percent(summed > 0 ? Value(sum / summed) : Value()));
  };
  add(kOursPaper, &SequenceScore::map_paper, score.map_paper);
  add(kOursArea, &SequenceScore::ap50, score.ap50);
  const std::string shared_text = count == 0
                                      ? "no sequence here is one of the paper's."
                                      : "Avg. of shared is over the " + std::to_string(count) + " that both the paper and this score have.";
  return "\n## Table 3: mAP of several systems (%)\n\n" + markdown_table(rows, 1) +
         "\nAverage is over each row's own sequences (as printed for the published ones); " + shared_text +
         " The\npaper prints 225 for 255 here. Its averages of Pham et al. and Grinvald et al. do not follow from their rows, which give "
         "42.0 and "
         "52.4.\n";
}

std::string ratio_text(double theirs, double ours) { return number("%.2f", ours > 0.0 ? Value(theirs / ours) : Value()); }

std::string tables_of_times(const SceneNnScore& score) {
  const StageTimes& times = *score.times;
  std::vector<std::string> without;
  for (const SequenceScore& one : score.sequences) {
    if (!one.times) without.push_back(one.name);
  }
  Rows rows = {{"Module", "waretwin (ms)", "paper, CPU (ms)", "CPU / ours", "paper, GPU (ms)", "GPU / ours"}};
  const std::vector<double> ours = {times.detect, times.segment, times.associate, times.integrate, times.total()};
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const PaperModule& module = paper_table4()[i];
    rows.push_back({module.name, number("%.2f", ours[i]), number("%.2f", module.cpu_ms), ratio_text(module.cpu_ms, ours[i]),
                    number("%.2f", module.gpu_ms), ratio_text(module.gpu_ms, ours[i])});
  }
  const auto fps = [](double total_ms) { return number("%.2f", total_ms > 0.0 ? Value(1000.0 / total_ms) : Value()); };
  const PaperModule& total = paper_table4().back();
  rows.push_back({"FPS (Hz)", fps(times.total()), fps(total.cpu_ms), ratio_text(total.cpu_ms, times.total()), fps(total.gpu_ms),
                  ratio_text(total.gpu_ms, times.total())});
  rows.push_back({"Localisation (not in the total)", number("%.2f", times.localise), "-", "-", "-", "-"});
  std::string text = "\n## Table 4: mean time of each module\n\n" + markdown_table(rows, 1) + "\nOver " + std::to_string(times.frames) +
                     " mapped frames, each sequence counting the same; ratios above 1: ours is faster. The paper's CPU is an i7-8565U " +
                     "(1.8 GHz), its GPU an RTX 3050 Ti.\n";
  if (!without.empty()) {
    text += "Without timing.csv or mapped frames, and not in it:";
    for (const std::string& name : without) text += " " + cell(name);
    text += ".\n";
  }

  Rows systems = {{"Method", "Platform", "Frequency", "Map", "FPS"}};
  for (const PaperSystem& system : paper_table5()) {
    systems.push_back({system.name, system.platform, system.frequency, system.map, number("%g", system.fps) + " Hz"});
  }
  systems.push_back({kOurs, "None (CPU)", "every mapped frame", "object-oriented", fps(times.total()) + " Hz"});
  return text + "\n## Table 5: frame rates\n\n" + markdown_table(systems, 4);
}

}  // namespace

std::string scenenn_tables(const SceneNnScore& score, const std::string& title) {
  const ClassColumns columns(score);
  std::string text = "# SceneNN protocol: " + cell(title) + "\n\nRows of " + kPaper + " and of other systems: Zhou et al., \"Efficient " +
                     "Object-Level Semantic Mapping with RGB-D Cameras\", Tables 1 to 5.\n";
  text += table1(score, columns) + table2(score, columns) + table3(score);
  if (score.times) text += tables_of_times(score);
  return text;
}

}  // namespace waretwin
