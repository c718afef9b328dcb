#include "harness/score/detection_score.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/files.h"
#include "core/random.h"
#include "harness/labelled/labelled_set.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

using Json = nlohmann::json;

cv::Rect2d rect(const Json& bbox) { return {bbox[0], bbox[1], bbox[2], bbox[3]}; }

// The published detections by image id, classes by index.
std::map<int, std::vector<ScoredBox>> published_detections(const std::map<int, int>& classes) {
  std::map<int, std::vector<ScoredBox>> detections;
  for (const Json& d : Json::parse(read_file(test::shared_data("detection_metrics/cocoapi_results.json")))) {
    detections[d["image_id"]].push_back({classes.at(d["category_id"]), rect(d["bbox"]), d["score"]});
  }
  return detections;
}

void expect_official_answers(const CocoFigures& all) {
  constexpr double kTolerance = 1e-6;
  EXPECT_NEAR(all.ap.value(), 0.503647, kTolerance);
  EXPECT_NEAR(all.ap50.value(), 0.696973, kTolerance);
  EXPECT_NEAR(all.ap75.value(), 0.571667, kTolerance);
  EXPECT_NEAR(all.ap_small.value(), 0.593252, kTolerance);
  EXPECT_NEAR(all.ap_medium.value(), 0.557991, kTolerance);
  EXPECT_NEAR(all.ap_large.value(), 0.489363, kTolerance);
  EXPECT_NEAR(all.ar1.value(), 0.386813, kTolerance);
  EXPECT_NEAR(all.ar10.value(), 0.593680, kTolerance);
  EXPECT_NEAR(all.ar100.value(), 0.595353, kTolerance);
  EXPECT_NEAR(all.ar_small.value(), 0.654764, kTolerance);
  EXPECT_NEAR(all.ar_medium.value(), 0.603130, kTolerance);
  EXPECT_NEAR(all.ar_large.value(), 0.553744, kTolerance);
}

TEST(CocoScore, ReproducesTheOfficialEvaluator) {
  WARETWIN_NEED_DATA("detection_metrics");
  const Json truth = Json::parse(read_file(test::shared_data("detection_metrics/sampled_gts_bbox_area.json")));
  std::map<int, int> classes;
  for (const Json& category : truth["categories"]) classes[category["id"]] = 0;
  int count = 0;
  for (auto& [id, index] : classes) index = count++;
  std::map<int, ScoredPicture> by_id;  // the evaluator goes by image id, too
  for (const Json& image : truth["images"]) by_id[image["id"]];
  for (const Json& a : truth["annotations"]) {
    by_id.at(a["image_id"]).truth.push_back({classes.at(a["category_id"]), rect(a["bbox"]), a["area"], a["iscrowd"] == 1});
  }
  for (const auto& [id, detections] : published_detections(classes)) by_id.at(id).detections = detections;
  std::vector<ScoredPicture> pictures;
  for (const auto& [id, picture] : by_id) pictures.push_back(picture);
  expect_official_answers(score_coco(pictures, count).all);
}

TEST(CocoScore, ReproducesTheOfficialEvaluatorThroughTheReader) {
  WARETWIN_NEED_DATA("detection_metrics");
  const test::TemporaryFolder folder;
  const std::string text = read_file(test::shared_data("detection_metrics/sampled_gts_bbox_area.json"));
  write_file(folder.path() / "truth.json", text);
  const Json truth = Json::parse(text);
  std::map<std::string, std::pair<int, cv::Size>> images;
  for (const Json& image : truth["images"]) {
    write_file(folder.path() / image["file_name"].get<std::string>(), "");
    images[image["file_name"]] = {image["id"], cv::Size(image["width"], image["height"])};
  }
  const LabelledSet set = read_labelled_set(folder.path() / "truth.json", "all");
  ASSERT_EQ(set.images.size(), 100u);
  ASSERT_EQ(set.classes.size(), 80u);
  std::map<int, int> classes;
  for (const Json& category : truth["categories"]) {
    const auto name = std::find(set.classes.begin(), set.classes.end(), category["name"].get<std::string>());
    classes[category["id"]] = static_cast<int>(name - set.classes.begin());
  }
  auto detections = published_detections(classes);
  std::map<int, ScoredPicture> by_id;
  for (const LabelledImage& image : set.images) {
    const auto& [id, size] = images.at(image.name);
    ScoredPicture& picture = by_id[id];
    picture.detections = detections[id];
    for (const LabelledBox& label : image.boxes) {
      const cv::Rect2d box(label.share.x * size.width, label.share.y * size.height, label.share.width * size.width,
                           label.share.height * size.height);
      picture.truth.push_back({label.class_index, box, label.area * size.area(), label.ignored});
    }
  }
  std::vector<ScoredPicture> pictures;
  for (const auto& [id, picture] : by_id) pictures.push_back(picture);
  expect_official_answers(score_coco(pictures, 80).all);
}

// Boxes of 100 x 100 in a row, 200 apart; a shift of s pixels gives IoU (100 - s) / (100 + s).
TrueBox truth_at(int place, int class_index = 0) { return {class_index, cv::Rect2d(200.0 * place, 0, 100, 100)}; }
ScoredBox found_at(int place, double score, double shift = 0.0, int class_index = 0) {
  return {class_index, cv::Rect2d(200.0 * place + shift, 0, 100, 100), score};
}

TEST(CocoScore, ClosedForms) {
  // Two of four found at once, one mistake in between: precision 1 to recall 0.25, 2/3 to 0.5, then nothing.
  const ScoredPicture picture{{truth_at(0), truth_at(1), truth_at(2), truth_at(3)}, {found_at(0, 0.9), found_at(8, 0.8), found_at(1, 0.7)}};
  const CocoScore score = score_coco({picture}, 2);
  EXPECT_NEAR(score.all.ap50.value(), (26 * 1.0 + 25 * 2.0 / 3.0) / 101, 1e-12);
  EXPECT_NEAR(score.all.ap.value(), score.all.ap50.value(), 1e-12);
  EXPECT_NEAR(score.all.ar100.value(), 0.5, 1e-12);
  EXPECT_NEAR(score.all.ar1.value(), 0.25, 1e-12);
  EXPECT_NEAR(score.all.ap_large.value(), score.all.ap.value(), 1e-12);
  EXPECT_FALSE(score.all.ap_small.has_value());
  EXPECT_FALSE(score.classes[1].ap.has_value());  // nothing there: no part of the mean
  // IoU 0.7 passes at five of ten thresholds: 0.50 .. 0.70 (a shift of 17 gives 83 / 117 = 0.709).
  const CocoScore shifted = score_coco({{{truth_at(0)}, {found_at(0, 0.5, 17.0)}}}, 1);
  EXPECT_NEAR(shifted.all.ap.value(), 0.5, 1e-12);
  EXPECT_NEAR(shifted.all.ap50.value(), 1.0, 1e-12);
  EXPECT_NEAR(shifted.all.ap75.value(), 0.0, 1e-12);
  // Nothing detected; nothing to detect.
  EXPECT_EQ(score_coco({{{truth_at(0)}, {}}}, 1).all.ap.value(), 0.0);
  EXPECT_FALSE(score_coco({{{}, {found_at(0, 0.5)}}}, 1).all.ap.has_value());
  EXPECT_FALSE(score_coco({}, 1).all.ap.has_value());
}

TEST(CocoScore, WhatLiesInACrowdIsNoMistake) {
  TrueBox crowd{0, cv::Rect2d(1000, 0, 1000, 100)};
  crowd.ignored = true;
  const std::vector<ScoredBox> detections = {found_at(5, 0.9), found_at(7, 0.8), found_at(0, 0.7)};
  EXPECT_NEAR(score_coco({{{truth_at(0), crowd}, detections}}, 1).all.ap.value(), 1.0, 1e-12);
  EXPECT_NEAR(score_coco({{{truth_at(0)}, detections}}, 1).all.ap.value(), 1.0 / 3.0, 1e-12);
  // A crowd alone is nothing to be found.
  EXPECT_FALSE(score_coco({{{crowd}, detections}}, 1).all.ap.has_value());
  // A free object goes before the crowd that covers it better.
  const ScoredPicture both{{crowd, truth_at(6)}, {found_at(6, 0.9, 20.0)}};
  EXPECT_NEAR(score_coco({both}, 1).all.ap50.value(), 1.0, 1e-12);
  EXPECT_NEAR(score_pascal({both}, 1).all.every_point.value(), 0.0, 1e-12);  // Pascal asks for the best overlap alone
}

// The definitions again, without sharing of work: everything is found anew for each class, area, threshold and limit.
double reference_overlap(const cv::Rect2d& d, const TrueBox& t) {
  const double both = (d & t.box).area();
  return both / (t.ignored ? d.area() : d.area() + t.box.area() - both);
}

struct Reference {
  std::vector<std::pair<double, bool>> ranked;  // score, right
  int to_find = 0;
};

Reference reference_matches(const std::vector<ScoredPicture>& pictures, int k, double iou, double least, double most, std::size_t limit) {
  Reference result;
  for (const ScoredPicture& picture : pictures) {
    std::vector<TrueBox> free, ignored;
    for (const TrueBox& t : picture.truth) {
      if (t.class_index != k) continue;
      const bool counts = !t.ignored && t.size() >= least && t.size() <= most;
      (counts ? free : ignored).push_back(t);
    }
    result.to_find += static_cast<int>(free.size());
    std::vector<ScoredBox> detections;
    for (const ScoredBox& d : picture.detections) {
      if (d.class_index == k) detections.push_back(d);
    }
    std::stable_sort(detections.begin(), detections.end(), [](const ScoredBox& a, const ScoredBox& b) { return a.score > b.score; });
    if (detections.size() > limit) detections.resize(limit);
    for (const ScoredBox& d : detections) {
      const auto best_of = [&](std::vector<TrueBox>& boxes) {
        auto best = boxes.end();
        for (auto t = boxes.begin(); t != boxes.end(); ++t) {
          const double value = reference_overlap(d.box, *t);
          if (value >= iou && (best == boxes.end() || value >= reference_overlap(d.box, *best))) best = t;
        }
        return best;
      };
      if (const auto hit = best_of(free); hit != free.end()) {
        free.erase(hit);
        result.ranked.emplace_back(d.score, true);
      } else if (const auto excuse = best_of(ignored); excuse != ignored.end()) {
        if (!excuse->ignored) ignored.erase(excuse);  // one of another size stands for one detection, a crowd for many
      } else if (d.box.area() >= least && d.box.area() <= most) {
        result.ranked.emplace_back(d.score, false);
      }
    }
  }
  std::stable_sort(result.ranked.begin(), result.ranked.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  return result;
}

// Highest precision at a recall of `recall` or beyond.
double precision_from(const Reference& r, double recall) {
  double best = 0.0;
  int right = 0, all = 0;
  for (const auto& [score, hit] : r.ranked) {
    right += hit ? 1 : 0;
    ++all;
    if (static_cast<double>(right) / r.to_find >= recall) best = std::max(best, static_cast<double>(right) / all);
  }
  return best;
}

std::optional<double> reference_ap(const std::vector<ScoredPicture>& pictures, int k, const std::vector<double>& ious, double least,
                                   double most) {
  double sum = 0.0;
  for (const double iou : ious) {
    const Reference r = reference_matches(pictures, k, iou, least, most, 100);
    if (r.to_find == 0) return std::nullopt;
    for (int step = 0; step <= 100; ++step) sum += precision_from(r, 0.01 * step) / 101.0;
  }
  return sum / static_cast<double>(ious.size());
}

std::optional<double> reference_ar(const std::vector<ScoredPicture>& pictures, int k, const std::vector<double>& ious, double least,
                                   double most, std::size_t limit) {
  double sum = 0.0;
  for (const double iou : ious) {
    const Reference r = reference_matches(pictures, k, iou, least, most, limit);
    if (r.to_find == 0) return std::nullopt;
    for (const auto& [score, hit] : r.ranked) sum += hit ? 1.0 / r.to_find : 0.0;
  }
  return sum / static_cast<double>(ious.size());
}

std::vector<ScoredPicture> random_pictures(std::uint64_t seed, int classes) {
  const RandomStream random(seed, "detection", "boxes");
  std::uint64_t draw = 0;
  const auto uniform = [&](double low, double high) { return low + (high - low) * random.uniform(draw++); };
  std::vector<ScoredPicture> pictures(12);
  for (ScoredPicture& picture : pictures) {
    const int count = static_cast<int>(uniform(0, 9));
    for (int i = 0; i < count; ++i) {
      const double side = uniform(0, 1) < 0.4 ? 30 : 110;
      TrueBox box{static_cast<int>(uniform(0, classes)),
                  {uniform(0, 500), uniform(0, 400), uniform(0.5, 1.5) * side, uniform(0.5, 1.5) * side}};
      box.ignored = uniform(0, 1) < 0.15;
      if (uniform(0, 1) < 0.3) box.area = 0.6 * box.box.area();
      picture.truth.push_back(box);
      const int hits = static_cast<int>(uniform(0, 3));
      for (int h = 0; h < hits; ++h) {
        cv::Rect2d near = box.box;
        near.x += uniform(-0.2, 0.2) * side;
        near.width *= uniform(0.8, 1.25);
        const int class_index = uniform(0, 1) < 0.2 ? static_cast<int>(uniform(0, classes)) : box.class_index;
        picture.detections.push_back({class_index, near, uniform(0, 1)});
      }
    }
    for (int i = 0; i < 3; ++i) {
      picture.detections.push_back({static_cast<int>(uniform(0, classes)), {uniform(0, 500), uniform(0, 400), 60, 80}, uniform(0, 0.6)});
    }
  }
  return pictures;
}

void expect_same(const std::optional<double>& fast, const std::optional<double>& slow, const char* what) {
  ASSERT_EQ(fast.has_value(), slow.has_value()) << what;
  EXPECT_NEAR(fast.value_or(0.0), slow.value_or(0.0), 1e-12) << what;
}

TEST(CocoScore, AgreesWithTheDefinitionsOnRandomBoxes) {
  constexpr int kClasses = 3;
  constexpr double kSmall = 32.0 * 32.0, kLarge = 96.0 * 96.0, kAny = 1e10;
  std::vector<double> ious;
  for (int i = 0; i < 10; ++i) ious.push_back(0.5 + 0.05 * i);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<ScoredPicture> pictures = random_pictures(seed, kClasses);
    const CocoScore score = score_coco(pictures, kClasses);
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < kClasses; ++k) {
      const CocoFigures& c = score.classes[static_cast<std::size_t>(k)];
      expect_same(c.ap, reference_ap(pictures, k, ious, 0, kAny), "ap");
      expect_same(c.ap50, reference_ap(pictures, k, {0.5}, 0, kAny), "ap50");
      expect_same(c.ap75, reference_ap(pictures, k, {0.75}, 0, kAny), "ap75");
      expect_same(c.ap_small, reference_ap(pictures, k, ious, 0, kSmall), "small");
      expect_same(c.ap_medium, reference_ap(pictures, k, ious, kSmall, kLarge), "medium");
      expect_same(c.ap_large, reference_ap(pictures, k, ious, kLarge, kAny), "large");
      expect_same(c.ar1, reference_ar(pictures, k, ious, 0, kAny, 1), "ar1");
      expect_same(c.ar10, reference_ar(pictures, k, ious, 0, kAny, 10), "ar10");
      expect_same(c.ar100, reference_ar(pictures, k, ious, 0, kAny, 100), "ar100");
      expect_same(c.ar_small, reference_ar(pictures, k, ious, 0, kSmall, 100), "ar small");
      expect_same(c.ar_large, reference_ar(pictures, k, ious, kLarge, kAny, 100), "ar large");
      if (c.ap) {
        sum += *c.ap;
        ++count;
      }
    }
    EXPECT_NEAR(score.all.ap.value(), sum / count, 1e-12);
  }
}

TEST(PascalScore, ClosedForms) {
  // Right, wrong, right, wrong (found already) of four: precision 1, 1/2, 2/3, 1/2.
  const ScoredPicture picture{{truth_at(0), truth_at(1), truth_at(2), truth_at(3)},
                              {found_at(0, 0.9), found_at(8, 0.8), found_at(1, 0.7), found_at(0, 0.6, 10.0)}};
  const PascalScore score = score_pascal({picture}, 2);
  EXPECT_NEAR(score.all.every_point.value(), 0.25 * 1.0 + 0.25 * 2.0 / 3.0, 1e-12);
  EXPECT_NEAR(score.all.eleven_point.value(), (3 * 1.0 + 3 * 2.0 / 3.0) / 11.0, 1e-12);  // recall 0, .1, .2; .3, .4, .5
  EXPECT_FALSE(score.classes[1].every_point.has_value());
  // Three of ten reach a recall of 0.3 exactly.
  ScoredPicture ten;
  for (int i = 0; i < 10; ++i) ten.truth.push_back(truth_at(i));
  for (int i = 0; i < 3; ++i) ten.detections.push_back(found_at(i, 0.5));
  EXPECT_NEAR(score_pascal({ten}, 1).all.eleven_point.value(), 4.0 / 11.0, 1e-12);
  // A "difficult" one neither helps nor harms.
  ScoredPicture difficult = picture;
  difficult.truth.push_back(truth_at(8));
  difficult.truth.back().ignored = true;
  EXPECT_NEAR(score_pascal({difficult}, 1).all.every_point.value(), 0.5, 1e-12);
}

TEST(PascalScore, AgreesWithTheDefinitionsOnRandomBoxes) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<ScoredPicture> pictures = random_pictures(seed, 2);
    const PascalScore score = score_pascal(pictures, 2);
    for (int k = 0; k < 2; ++k) {
      struct One {
        double score;
        std::size_t picture, truth;  // the true box it overlaps most, by half or more
        bool near;
      };
      std::vector<One> all;
      Reference r;
      for (std::size_t p = 0; p < pictures.size(); ++p) {
        for (const TrueBox& t : pictures[p].truth) r.to_find += t.class_index == k && !t.ignored ? 1 : 0;
        for (const ScoredBox& d : pictures[p].detections) {
          if (d.class_index != k) continue;
          One one{d.score, p, 0, false};
          double best = 0.0;
          for (std::size_t g = 0; g < pictures[p].truth.size(); ++g) {
            const TrueBox& t = pictures[p].truth[g];
            const double value = t.class_index == k ? reference_overlap(d.box, t) : 0.0;
            if (value > best) one = {d.score, p, g, value >= 0.5};
            best = std::max(best, value);
          }
          if (!one.near || !pictures[p].truth[one.truth].ignored) all.push_back(one);
        }
      }
      std::stable_sort(all.begin(), all.end(), [](const One& a, const One& b) { return a.score > b.score; });
      std::set<std::pair<std::size_t, std::size_t>> found;
      for (const One& one : all) r.ranked.emplace_back(one.score, one.near && found.emplace(one.picture, one.truth).second);
      ASSERT_GT(r.to_find, 0);
      double eleven = 0.0, area = 0.0;
      for (int tenth = 0; tenth <= 10; ++tenth) eleven += precision_from(r, tenth / 10.0) / 11.0;
      for (int hits = 1; hits <= r.to_find; ++hits) area += precision_from(r, static_cast<double>(hits) / r.to_find) / r.to_find;
      EXPECT_NEAR(score.classes[static_cast<std::size_t>(k)].eleven_point.value(), eleven, 1e-12);
      EXPECT_NEAR(score.classes[static_cast<std::size_t>(k)].every_point.value(), area, 1e-12);
    }
  }
}

TEST(ThresholdScore, CountsAndConfusions) {
  // Two chairs (class 0), three tables (1); a crowd of chairs.
  ScoredPicture picture{{truth_at(0, 0), truth_at(1, 0), truth_at(2, 1), truth_at(3, 1), truth_at(4, 1), truth_at(7, 0)}, {}};
  picture.truth.back().ignored = true;
  picture.detections = {found_at(0, 0.9, 5.0, 0),   // a chair
                        found_at(1, 0.8, 5.0, 1),   // a chair taken for a table
                        found_at(2, 0.7, 5.0, 1),   // a table
                        found_at(2, 0.6, 10.0, 1),  // the same once more: background
                        found_at(9, 0.6, 0.0, 2),   // background taken for class 2
                        found_at(9, 0.4, 0.0, 2),   // too weak
                        found_at(7, 0.9, 0.0, 0)};  // in the crowd
  const ThresholdScore score = score_at_threshold({picture}, 3, {.confidence = 0.5, .match_iou = 0.5});
  EXPECT_EQ(score.all.right, 2);
  EXPECT_EQ(score.all.wrong, 3);
  EXPECT_EQ(score.all.missed, 3);
  EXPECT_NEAR(score.all.precision().value(), 0.4, 1e-12);
  EXPECT_NEAR(score.all.recall().value(), 0.4, 1e-12);
  EXPECT_EQ(score.classes[0].missed, 1);
  EXPECT_EQ(score.classes[1].wrong, 2);
  EXPECT_NEAR(score.map_paper.value(), (1.0 + 1.0 / 3.0) / 2.0, 1e-12);  // class 2 has no objects
  const auto count = [&](std::optional<int> truth, std::optional<int> detected) {
    for (const Confusion& c : score.confusions) {
      if (c.truth == truth && c.detected == detected) return c.count;
    }
    return 0;
  };
  ASSERT_EQ(score.confusions.size(), 4u);
  EXPECT_EQ(score.confusions[0].count, 2);
  EXPECT_EQ(count(1, std::nullopt), 2);
  EXPECT_EQ(count(0, 1), 1);
  EXPECT_EQ(count(std::nullopt, 1), 1);
  EXPECT_EQ(count(std::nullopt, 2), 1);
  // Every label is found, missed or confused: the list adds up.
  const ThresholdScore strict = score_at_threshold({picture}, 3, {.confidence = 0.95, .match_iou = 0.5});
  EXPECT_FALSE(strict.all.precision().has_value());
  EXPECT_EQ(strict.all.recall().value(), 0.0);
  EXPECT_EQ(strict.map_paper.value(), 0.0);
  EXPECT_FALSE(score_at_threshold({}, 3, {}).map_paper.has_value());
}

TEST(ThresholdScore, AgreesWithTheDefinitionsOnRandomBoxes) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const std::vector<ScoredPicture> pictures = random_pictures(seed, 3);
    std::vector<ScoredPicture> strong = pictures;
    for (ScoredPicture& picture : strong) std::erase_if(picture.detections, [](const ScoredBox& d) { return d.score < 0.4; });
    const ThresholdScore score = score_at_threshold(pictures, 3, {.confidence = 0.4, .match_iou = 0.5});
    int wrong = 0, missed = 0;
    for (int k = 0; k < 3; ++k) {
      const Reference r = reference_matches(strong, k, 0.5, 0.0, 1e10, 1000);
      int right = 0;
      for (const auto& [value, hit] : r.ranked) right += hit ? 1 : 0;
      const ThresholdFigures& c = score.classes[static_cast<std::size_t>(k)];
      EXPECT_EQ(c.right, right);
      EXPECT_EQ(c.wrong, static_cast<int>(r.ranked.size()) - right);
      EXPECT_EQ(c.missed, r.to_find - right);
      wrong += c.wrong;
      missed += c.missed;
    }
    int listed_wrong = 0, listed_missed = 0;
    for (const Confusion& c : score.confusions) {
      listed_wrong += c.detected ? c.count : 0;
      listed_missed += c.truth ? c.count : 0;
    }
    EXPECT_EQ(listed_wrong, wrong);
    EXPECT_EQ(listed_missed, missed);
  }
}

TEST(DetectionScore, MetricsHoldWhatToolsReadAndNoNan) {
  const std::vector<ScoredPicture> pictures = {{{truth_at(0)}, {found_at(0, 0.9), found_at(5, 0.2)}}};
  const DetectionScore score = score_detections(pictures, {"chair", "table", "caf\xe9"}, {});  // the last in Latin-1
  EXPECT_EQ(score.label_count(), 1);
  const DetectionRunFacts facts{"model", "set", "test", 0.001, 12.5};
  const Json json = Json::parse(metrics_json(score, facts));
  for (const char* key : {"ap50", "ap", "precision", "recall"}) EXPECT_NEAR(json[key].get<double>(), 1.0, 1e-12) << key;
  EXPECT_EQ(json["images"], 1);
  EXPECT_EQ(json["labels"], 1);
  EXPECT_EQ(json["median_ms"], 12.5);
  EXPECT_TRUE(json["ap_small"].is_null());
  EXPECT_EQ(json["classes"][1]["class"], "table");
  EXPECT_TRUE(json["confusions"].empty());  // the weak one does not count
  EXPECT_NE(metrics_table(score, facts).find("chair"), std::string::npos);
  EXPECT_EQ(metrics_table(score, facts).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace waretwin
