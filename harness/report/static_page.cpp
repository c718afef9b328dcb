#include "harness/report/static_page.h"

#include <algorithm>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/pose.h"
#include "harness/pictures/picture_file.h"
#include "harness/report/base64.h"
#include "harness/report/page_json.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

const Json kNothing;

const Json& get(const Json& json, const char* key) {
  if (!json.is_object()) return kNothing;
  const auto found = json.find(key);
  return found == json.end() ? kNothing : *found;
}

std::string number(const char* pattern, const Json& value) {
  if (!value.is_number()) return "&ndash;";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, pattern, value.get<double>());
  return buffer;
}

std::string word(const Json& value) {
  if (value.is_string()) return escaped(value.get<std::string>());
  return value.is_null() ? "&ndash;" : escaped(value.dump());
}

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  return text + "</tr>\n";
}

std::string score_table(const Json& objects, const Json& summary, const Json& paper) {
  std::string text =
      "<table>\n" + row({"object", "class", "map id", "IoU<sub>3D</sub>", "E<sub>trans</sub> (m)", "E<sub>rot</sub> (deg)", "seen"}, "th");
  for (const Json& object : objects) {
    text += row({word(get(object, "truth_id")) + (get(object, "counted") == false ? " (not counted)" : ""), word(get(object, "class")),
                 word(get(object, "map_id")), number("%.4f", get(object, "iou3d")), number("%.3f", get(object, "e_trans_m")),
                 number("%.1f", get(object, "e_rot_deg")), number("%.2f", get(object, "visible_fraction"))});
  }
  text += row({"<b>average</b>", "", "", number("%.4f", get(summary, "mean_iou3d")), number("%.3f", get(summary, "mean_e_trans_m")),
               number("%.1f", get(summary, "mean_e_rot_deg")), ""});
  if (!paper.empty()) {
    const Json& mean = paper.back();
    text += row({"<b>the paper</b>", "", "", number("%.4f", get(mean, "iou3d")), number("%.3f", get(mean, "e_trans_m")),
                 number("%.1f", get(mean, "e_rot_deg")), ""});
  }
  return text + "</table>\n<p>" + word(get(summary, "matched")) + " of " + word(get(summary, "truth")) + " objects matched, " +
         word(get(summary, "mapped")) + " mapped; mAP as in the paper " + number("%.2f", get(summary, "map_paper")) + ", AP<sub>50</sub> " +
         number("%.2f", get(summary, "ap50")) + ".</p>\n";
}

std::string object_table(const Json& objects) {
  std::string text = "<table>\n" + row({"map id", "class", "centre (m)", "size (m)", "yaw (deg)", "score"}, "th");
  for (const Json& object : objects) {
    const auto triple = [](const Json& v) {
      return number("%.2f", v.at(0)) + ", " + number("%.2f", v.at(1)) + ", " + number("%.2f", v.at(2));
    };
    text += row({word(get(object, "id")), word(get(object, "class")), triple(get(object, "centre")), triple(get(object, "size")),
                 number("%.1f", to_degrees(object.value("yaw", 0.0))), number("%.2f", get(object, "score"))});
  }
  return text + "</table>\n";
}

std::string detection_table(const Json& detection) {
  std::string text = "<table>\n" + row({"class", "labels", "precision", "recall", "AP<sub>50</sub>", "found", "wrong", "missed"}, "th");
  const auto line = [&](const std::string& name, const Json& figures) {
    text += row({name, word(get(figures, "labels")), number("%.3f", get(figures, "precision")), number("%.3f", get(figures, "recall")),
                 number("%.3f", get(figures, "ap50")), word(get(figures, "tp")), word(get(figures, "fp")), word(get(figures, "fn"))});
  };
  for (const Json& figures : get(detection, "classes")) line(word(get(figures, "class")), figures);
  line("<b>all</b>", detection);
  text += "</table>\n<ul>\n";
  for (const Json& confusion : get(detection, "confusions")) {
    const auto name = [&](const char* key) {
      return get(confusion, key).is_null() ? std::string("background") : word(get(confusion, key));
    };
    text += "<li>" + name("truth") + (get(confusion, "detected").is_null() ? std::string(" missed") : " taken for " + name("detected")) +
            ", " + word(get(confusion, "count")) + " times</li>\n";
  }
  return text + "</ul>\n";
}

std::string timing_table(const Json& stages) {
  std::string text = "<table>\n" + row({"stage", "mean (ms)", "median (ms)", "95 % (ms)", "largest (ms)"}, "th");
  for (const Json& stage : stages) {
    text += row({word(get(stage, "stage")), number("%.1f", get(stage, "mean")), number("%.1f", get(stage, "median")),
                 number("%.1f", get(stage, "p95")), number("%.1f", get(stage, "max"))});
  }
  return text + "</table>\n";
}

std::string figure(const std::string& caption, const std::string& jpeg) {
  return "<figure><img alt=\"" + escaped(caption) + "\" src=\"data:image/jpeg;base64," + base64(jpeg) + "\"><figcaption>" +
         escaped(caption) + "</figcaption></figure>\n";
}

// Two frames: one early, one late.
std::string frame_figures(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder / "frames", error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (name.ends_with(".colour.png")) names.push_back(name.substr(0, name.size() - std::string(".colour.png").size()));
  }
  std::sort(names.begin(), names.end());
  std::string html;
  if (names.empty()) return html;
  const auto show = [&](const std::string& name, const char* kind, const char* caption) {
    const fs::path file = folder / "frames" / (name + kind + ".png");
    const cv::Mat image = fs::exists(file, error) ? cv::imread(file.string(), cv::IMREAD_COLOR) : cv::Mat();
    if (!image.empty()) html += figure(name + ": " + caption, encoded_jpeg(image, 85));
  };
  for (const std::size_t third : {std::size_t{1}, std::size_t{2}}) {
    const std::string& name = names[names.size() * third / 3];
    show(name, ".colour", "detections, segmented pixels, mapped cuboids");
    show(name, ".depth", "depth as measured");
    show(name, ".truth", "true objects, their visible (solid) and whole (dashed) boxes");
  }
  return html;
}

std::string run_parts(const Json& json) {
  std::string html;
  const Json& score = get(json, "score");
  if (score.is_object()) {
    const Json& table6 = get(get(json, "paper"), "table6");
    html += "<h2>Table 6, as mapped</h2>\n" + score_table(get(score, "objects"), get(score, "summary"), table6);
    if (!get(score, "objects_aligned").is_null()) {
      html += "<h2>Table 6, after aligning the map to the truth by one planar motion</h2>\n" +
              score_table(get(score, "objects_aligned"), get(score, "summary_aligned"), table6);
    }
    if (!get(score, "explanations").empty()) {
      html += "<h2>What is wrong</h2>\n<ul>\n";
      for (const Json& line : get(score, "explanations")) {
        html += "<li>" +
                (get(line, "truth_id").is_null() ? "Mapped object " + word(get(line, "map_id")) : "Object " + word(get(line, "truth_id"))) +
                ": " + word(get(line, "text")) + "</li>\n";
      }
      html += "</ul>\n";
    }
  }
  if (!get(json, "mapped").empty()) html += "<h2>Mapped objects</h2>\n" + object_table(get(json, "mapped"));
  if (get(score, "detection").is_object()) {
    html += "<h2>Detections in the mapped frames</h2>\n" + detection_table(get(score, "detection"));
  }
  const Json& timing = get(json, "timing");
  if (timing.is_object()) html += "<h2>Time per mapped frame</h2>\n" + timing_table(get(timing, "stages"));
  for (const auto& [key, title] : {std::pair{"budget", "Budget of errors"}, std::pair{"verdict", "Against the baseline"}}) {
    if (get(json, key).is_string()) html += std::string("<h2>") + title + "</h2>\n<pre>" + word(get(json, key)) + "</pre>\n";
  }
  return html;
}

std::string study_parts(const Json& study) {
  const Json& measures = get(study, "measures");
  std::vector<std::string> heading = {"candidate", "state"};
  for (const Json& factor : get(study, "factors")) heading.push_back(word(get(factor, "name")));
  for (const Json& measure : measures) heading.push_back(word(get(measure, "name")));
  std::string html;
  if (get(study, "verdict").is_string()) html += "<p><b>Best</b>: " + word(get(study, "verdict")) + "</p>\n";
  html += "<h2>Candidates</h2>\n<table>\n" + row(heading, "th");
  for (const Json& candidate : get(study, "candidates")) {
    const bool best = get(candidate, "number") == get(study, "best");
    std::string state = word(get(candidate, "state"));
    if (get(candidate, "broken").is_array()) {
      for (const Json& text : get(candidate, "broken")) state += "; " + word(text);
    }
    std::vector<std::string> cells = {(best ? "<b>" : "") + word(get(candidate, "name")) + (best ? " (best)</b>" : ""), state};
    for (const Json& factor : get(study, "factors")) {
      cells.push_back(word(get(get(candidate, "values"), get(factor, "name").get<std::string>().c_str())));
    }
    for (const Json& measure : measures) {
      cells.push_back(number("%.4g", get(get(get(candidate, "measures"), get(measure, "name").get<std::string>().c_str()), "mean")));
    }
    html += row(cells);
  }
  return html + "</table>\n";
}

std::string dataset_parts(const Json& dataset) {
  std::string html = "<h2>Labels</h2>\n<table>\n" + row({"class", "labels"}, "th");
  for (const Json& entry : get(dataset, "classes")) html += row({word(get(entry, "name")), word(get(entry, "labels"))});
  return html + "</table>\n";
}

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:.6em 0}th,td{border:1px solid #ccc;padding:.25em .7em;text-align:right}"
    "th{background:#f2f2f2}th:first-child,td:first-child{text-align:left}figure{margin:1em 0}img{max-width:100%}"
    "figcaption,.note{color:#666;font-size:90%}pre{overflow:auto}";

}  // namespace

std::string static_page(const PageData& data, const fs::path& folder) {
  const Json& json = data.json;
  const std::string title = word(get(json, "title"));
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>waretwin: " + title + "</title>\n<style>" + kStyle +
      "</style>\n<h1>" + title + "</h1>\n<p>" + word(get(json, "subtitle")) +
      "</p>\n<p class=\"note\">This is the plain page: waretwin was built without Node, or its viewer could not be built. With it, "
      "<code>waretwin report</code> makes this page in 3D, with the drive's pictures.</p>\n";
  if (!get(json, "facts").empty()) {
    html += "<ul>\n";
    for (const Json& fact : get(json, "facts")) html += "<li>" + word(fact) + "</li>\n";
    html += "</ul>\n";
  }
  if (get(json, "study").is_object()) {
    html += study_parts(get(json, "study"));
  } else if (get(json, "dataset").is_object()) {
    html += dataset_parts(get(json, "dataset"));
  } else {
    html += run_parts(json);
  }
  if (!get(json, "pictures").empty()) {
    html += "<h2>Pictures</h2>\n";
    for (const Json& picture : get(json, "pictures")) {
      const auto block = data.blocks.find(get(picture, "block").get<std::string>());
      if (block != data.blocks.end()) html += figure(get(picture, "caption").get<std::string>(), block->second);
    }
    html += frame_figures(folder);
  }
  html += "<h2>Files</h2>\n<ul>\n";
  for (const Json& file : get(json, "files")) html += "<li><a href=\"" + word(file) + "\">" + word(file) + "</a></li>\n";
  return html + "</ul>\n<p>waretwin " + word(get(json, "version")) + "</p>\n</html>\n";
}

}  // namespace waretwin
