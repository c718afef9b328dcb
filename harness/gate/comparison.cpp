#include "harness/gate/comparison.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "harness/gate/markdown_table.h"

namespace waretwin {

namespace {

// Of sums in doubles that were written and read as text.
constexpr double kRounding = 1e-9;

Verdict verdict_of(const std::optional<double>& before, const std::optional<double>& after, bool more_is_better,
                   const std::optional<double>& tolerance) {
  if (!tolerance || !before) return Verdict::kNotJudged;
  if (!after) return Verdict::kWorse;
  const double gain = more_is_better ? *after - *before : *before - *after;
  if (gain < -*tolerance - kRounding) return Verdict::kWorse;
  return gain > *tolerance + kRounding ? Verdict::kBetter : Verdict::kSame;
}

std::string object_name(const JudgedObject& object) { return "object " + std::to_string(object.truth_id) + " (" + object.class_name + ")"; }

const JudgedObject* counted_object(const JudgedScore& score, const JudgedObject& like) {
  const auto found = std::find_if(score.objects.begin(), score.objects.end(), [&](const JudgedObject& object) {
    return object.counted && object.truth_id == like.truth_id && object.class_name == like.class_name;
  });
  return found == score.objects.end() ? nullptr : &*found;
}

void compare_objects(const JudgedScore& before, const JudgedScore& after, const std::optional<double>& tolerance, Comparison& comparison) {
  int lacking = 0, added = 0;
  for (const JudgedObject& object : before.objects) {
    if (!object.counted) continue;
    const JudgedObject* const now = counted_object(after, object);
    if (now == nullptr) {
      ++lacking;
      continue;
    }
    const Verdict verdict = verdict_of(object.iou3d, now->iou3d, true, tolerance);
    if (verdict == Verdict::kBetter || verdict == Verdict::kWorse)
      comparison.objects.push_back({object_name(object), object.iou3d, now->iou3d, tolerance, verdict});
  }
  for (const JudgedObject& object : after.objects) added += object.counted && counted_object(before, object) == nullptr ? 1 : 0;
  if (lacking > 0 || added > 0) {
    comparison.notes.push_back("not the same true objects count: " + std::to_string(lacking) + " only before, " + std::to_string(added) +
                               " only after");
  }
}

void note_difference(const char* what, const std::string& before, const std::string& after, Comparison& comparison) {
  if (before.empty() || after.empty() || before == after) return;
  comparison.notes.push_back(std::string(what) + ": " + before + " before, " + after + " after");
}

std::string number(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string value_text(const std::optional<double>& value) {
  if (!value) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.4f", *value);
  return text;
}

const char* verdict_text(const ComparedValue& value) {
  switch (value.verdict) {
    case Verdict::kBetter:
      return "better";
    case Verdict::kWorse:
      return value.after ? "**worse**" : "**gone**";
    case Verdict::kNotJudged:
      return value.tolerance && !value.before ? "new" : "not judged";
    case Verdict::kSame:
      break;
  }
  return "same";
}

using Row = std::vector<std::string>;

Row row_of(const ComparedValue& value) {
  std::string change = "-";
  if (value.before && value.after) {
    char text[64];
    std::snprintf(text, sizeof text, "%+.4f", *value.after - *value.before);
    change = text;
  }
  return {value.name,         value_text(value.before), value_text(value.after), change, value.tolerance ? number(*value.tolerance) : "-",
          verdict_text(value)};
}

bool is_of_trajectory(const Measure& measure) { return std::string_view(measure.place).starts_with("/trajectory/"); }

}  // namespace

bool Comparison::worse() const {
  const auto is_worse = [](const ComparedValue& value) { return value.verdict == Verdict::kWorse; };
  return std::any_of(values.begin(), values.end(), is_worse) || std::any_of(objects.begin(), objects.end(), is_worse);
}

Comparison compare_scores(const JudgedScore& before, const JudgedScore& after, const Tolerances& tolerances) {
  Comparison comparison;
  comparison.same_map = !before.digest.empty() && before.digest == after.digest;
  for (std::size_t i = 0; i < measures().size(); ++i) {
    const Measure& measure = measures()[i];
    ComparedValue value{measure.name, before.values[i], after.values[i], tolerances.measures.values[i], Verdict::kNotJudged};
    if (!value.before && !value.after) continue;
    // What one of the two has no stage for, or need not tell, is no loss.
    if (measure.ours && (before.of_another_mapper() || after.of_another_mapper())) value.tolerance.reset();
    if (is_of_trajectory(measure) && !value.after && after.of_another_mapper() && !before.of_another_mapper()) value.tolerance.reset();
    value.verdict = verdict_of(value.before, value.after, measure.more_is_better, value.tolerance);
    comparison.values.push_back(value);
  }
  compare_objects(before, after, tolerances.object_iou3d, comparison);
  note_difference("scenario", before.scenario, after.scenario, comparison);
  note_difference("profile", before.profile, after.profile, comparison);
  if (before.seed && after.seed) note_difference("seed", std::to_string(*before.seed), std::to_string(*after.seed), comparison);
  // Kernels are picked by CPU and differ in the last bits (docs/gates.md).
  note_difference("CPU", before.cpu, after.cpu, comparison);
  return comparison;
}

std::vector<MissedMark> missed_marks(const JudgedScore& score, const PassMarks& marks) {
  std::vector<MissedMark> missed;
  for (std::size_t i = 0; i < measures().size(); ++i) {
    const std::optional<double>&mark = marks.measures.values[i], &value = score.values[i];
    if (!mark) continue;
    const bool more = measures()[i].more_is_better;
    const bool reached = value && (more ? *value >= *mark - kRounding : *value <= *mark + kRounding);
    if (!reached) missed.push_back({measures()[i].name, value, *mark, more});
  }
  return missed;
}

std::string missed_text(const MissedMark& missed) {
  const std::string mark = number(missed.mark);
  std::string value = " has no value";
  if (missed.value) {
    value = " " + number(*missed.value);
    if (value == " " + mark) value = " " + std::to_string(*missed.value);  // 0.99996 is no 1
  }
  return missed.name + value + ", expected at " + (missed.more_is_better ? "least " : "most ") + mark;
}

std::vector<std::string> worse_texts(const Comparison& comparison) {
  std::vector<std::string> texts;
  for (const std::vector<ComparedValue>* list : {&comparison.values, &comparison.objects}) {
    for (const ComparedValue& value : *list) {
      if (value.verdict == Verdict::kWorse) texts.push_back(worse_text(value));
    }
  }
  return texts;
}

std::string worse_text(const ComparedValue& value) {
  return value.name + " was " + value_text(value.before) +
         (value.after ? ", is " + value_text(value.after) + ", may get worse by " + number(*value.tolerance) : " and has no value now");
}

std::string comparison_text(const Comparison& comparison) {
  std::vector<Row> rows = {{"measure", "before", "after", "change", "allowed", "verdict"}};
  for (const ComparedValue& value : comparison.values) rows.push_back(row_of(value));
  for (const ComparedValue& value : comparison.objects) rows.push_back(row_of(value));
  std::string text = markdown_table(rows, 1, true);
  if (comparison.same_map) text += "\nThe maps are the same to the last bit.\n";
  for (const std::string& note : comparison.notes) text += "\n" + note + "\n";
  return text;
}

}  // namespace waretwin
