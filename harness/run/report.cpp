#include "harness/run/report.h"

#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/version.h"
#include "harness/pictures/picture_file.h"

namespace waretwin {

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

std::string base64(const std::string& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&bytes](std::size_t i) { return i < bytes.size() ? unsigned{static_cast<unsigned char>(bytes[i])} : 0U; };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const unsigned word = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    text += kDigits[word >> 18 & 63];
    text += kDigits[word >> 12 & 63];
    text += left > 1 ? kDigits[word >> 6 & 63] : '=';
    text += left > 2 ? kDigits[word & 63] : '=';
  }
  return text;
}

std::string number(const char* pattern, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, pattern, value);
  return buffer;
}

std::string number(const char* pattern, const std::optional<double>& value) { return value ? number(pattern, *value) : "&ndash;"; }

std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string text = "<tr>";
  for (const std::string& cell : cells) text += std::string("<") + tag + ">" + cell + "</" + tag + ">";
  return text + "</tr>\n";
}

std::string score_table(const ObjectListScore& score) {
  std::string text =
      "<table>\n" + row({"object", "class", "map id", "IoU<sub>3D</sub>", "E<sub>trans</sub> (m)", "E<sub>rot</sub> (deg)", "seen"}, "th");
  for (const ObjectScore& object : score.objects) {
    text += row({std::to_string(object.truth_id) + (object.counted ? "" : " (not counted)"), escaped(object.class_name),
                 object.map_id ? std::to_string(*object.map_id) : "&ndash;", number("%.4f", object.iou3d), number("%.3f", object.e_trans_m),
                 number("%.1f", object.e_rot_deg), number("%.2f", object.visible_fraction)});
  }
  const ScoreSummary& s = score.summary;
  text +=
      row({"<b>average</b>", "", "", number("%.4f", s.mean_iou3d), number("%.3f", s.mean_e_trans_m), number("%.1f", s.mean_e_rot_deg), ""});
  text += row({"<b>the paper</b>", "", "", "0.7925", "0.045", "1.7", ""}) + "</table>\n";
  text += "<p>" + std::to_string(s.matched) + " of " + std::to_string(s.truth) + " objects matched, " + std::to_string(s.mapped) +
          " mapped; mAP as in the paper " + number("%.2f", s.map_paper) + ", AP<sub>50</sub> " + number("%.2f", s.ap50) + ".</p>\n";
  return text;
}

std::string detection_table(const DetectionScore& score) {
  std::string text = "<table>\n" + row({"class", "labels", "precision", "recall", "AP<sub>50</sub>", "found", "wrong", "missed"}, "th");
  const auto line = [&](const std::string& name, int labels, const ThresholdFigures& t, const std::optional<double>& ap50) {
    text += row({name, std::to_string(labels), number("%.3f", t.precision()), number("%.3f", t.recall()), number("%.3f", ap50),
                 std::to_string(t.right), std::to_string(t.wrong), std::to_string(t.missed)});
  };
  for (std::size_t k = 0; k < score.classes.size(); ++k) {
    line(escaped(score.classes[k]), score.labels[k], score.at_threshold.classes[k], score.coco.classes[k].ap50);
  }
  line("<b>all</b>", score.label_count(), score.at_threshold.all, score.coco.all.ap50);
  text += "</table>\n";
  const auto name = [&](const std::optional<int>& k) { return k ? escaped(score.classes[static_cast<std::size_t>(*k)]) : "background"; };
  const std::vector<Confusion>& confusions = score.at_threshold.confusions;
  if (confusions.empty()) return text;
  text += "<ul>\n";
  for (const Confusion& c : confusions) {
    text += "<li>" + name(c.truth) + (c.detected ? " taken for " + name(c.detected) : std::string(" missed")) + ", " +
            std::to_string(c.count) + " times</li>\n";
  }
  return text + "</ul>\n";
}

std::string object_table(const std::vector<ListedObject>& objects) {
  std::string text = "<table>\n" + row({"map id", "class", "centre (m)", "size (m)", "yaw (deg)", "score"}, "th");
  for (const ListedObject& object : objects) {
    const Cuboid& c = object.cuboid;
    const auto triple = [](const Eigen::Vector3d& v) {
      return number("%.2f", v.x()) + ", " + number("%.2f", v.y()) + ", " + number("%.2f", v.z());
    };
    text += row({std::to_string(object.id), escaped(object.class_name), triple(c.centre), triple(c.size), number("%.1f", to_degrees(c.yaw)),
                 number("%.2f", object.score)});
  }
  return text + "</table>\n";
}

std::string timing_table(const std::map<std::string, TimingSummary>& timing) {
  std::string text = "<table>\n" + row({"stage", "median (ms)", "95 % (ms)", "largest (ms)"}, "th");
  for (const char* stage : {"simulate", "localise", "detect", "segment", "associate", "integrate", "frame"}) {
    const auto found = timing.find(stage);
    if (found == timing.end()) continue;
    text += row({stage, number("%.1f", found->second.median), number("%.1f", found->second.p95), number("%.1f", found->second.max)});
  }
  return text + "</table>\n";
}

constexpr int kPictureQuality = 85;  // of JPEG

std::string figure(const ReportPicture& picture) {
  cv::Mat image = picture.image;
  if (image.cols > 1100) cv::resize(image, image, {}, 1100.0 / image.cols, 1100.0 / image.cols, cv::INTER_AREA);
  return "<figure><img alt=\"" + escaped(picture.caption) + "\" src=\"data:image/jpeg;base64," +
         base64(encoded_jpeg(image, kPictureQuality)) + "\"><figcaption>" + escaped(picture.caption) + "</figcaption></figure>\n";
}

constexpr const char* kStyle =
    "body{font:15px/1.5 sans-serif;max-width:1100px;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse;margin:.6em 0}th,td{border:1px solid #ccc;padding:.25em .7em;text-align:right}"
    "th{background:#f2f2f2}th:first-child,td:first-child{text-align:left}figure{margin:1em 0}img{max-width:100%}"
    "figcaption{color:#666;font-size:90%}";

}  // namespace

std::string report_html(const ReportPage& page) {
  std::string html = "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>" + escaped(page.title) + "</title>\n<style>" +
                     kStyle + "</style>\n<h1>" + escaped(page.title) + "</h1>\n<p>" + escaped(page.subtitle) + "</p>\n";
  if (!page.facts.empty()) {
    html += "<ul>\n";
    for (const std::string& fact : page.facts) html += "<li>" + escaped(fact) + "</li>\n";
    html += "</ul>\n";
  }
  if (page.score != nullptr) {
    html += "<h2>Table 6, as mapped</h2>\n" + score_table(page.score->objects.plain);
    if (page.score->objects.aligned) {
      html += "<h2>Table 6, after aligning the map to the truth by one planar motion</h2>\n" + score_table(*page.score->objects.aligned);
    }
  }
  html += "<h2>Mapped objects</h2>\n" + object_table(page.mapped);
  if (page.score != nullptr && page.score->detection) {
    html += "<h2>Detections in the mapped frames</h2>\n" + detection_table(*page.score->detection);
  }
  html += "<h2>Time per mapped frame</h2>\n" + timing_table(page.timing_ms);
  html += "<h2>Pictures</h2>\n";
  for (const ReportPicture& picture : page.pictures) html += figure(picture);
  html += "<h2>Files</h2>\n<ul>\n";
  for (const std::string& file : page.files) html += "<li><a href=\"" + escaped(file) + "\">" + escaped(file) + "</a></li>\n";
  return html + "</ul>\n<p>waretwin " + std::string(kVersion) + "</p>\n</html>\n";
}

}  // namespace waretwin
