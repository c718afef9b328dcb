// The page of a folder: what goes into it, what it refuses, and the plain page where there is no viewer.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "core/error.h"
#include "core/files.h"
#include "harness/pictures/picture_file.h"
#include "harness/report/base64.h"
#include "harness/report/dataset_page.h"
#include "harness/report/frame_log.h"
#include "harness/report/page_mesh.h"
#include "harness/report/page_template.h"
#include "harness/report/report_file.h"
#include "harness/report/run_page.h"
#include "harness/report/static_page.h"
#include "harness/report/study_page.h"
#include "harness/score/trajectory_file.h"
#include "mapper/output/map_files.h"
#include "tests/harness/score_fixtures.h"
#include "tests/support/expect_error.h"
#include "tests/support/test_data.h"

namespace waretwin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::TemporaryFolder;

TEST(Base64, IsThatOfTheStandard) {
  // RFC 4648, section 10.
  const std::pair<const char*, const char*> vectors[] = {
      {"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(base64(bytes), text);
  EXPECT_EQ(base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(PageTemplate, LetsNothingInTheDataEndItsElement) {
  PageData data;
  data.json["title"] = "</script><script>alert(1)</script><!--";
  data.blocks["one"] = "bytes";
  const std::string html = filled_page("<body><!--waretwin-data--></body>", data);
  EXPECT_EQ(html.find("alert(1)</"), std::string::npos);
  EXPECT_EQ(html.find("<!--"), std::string::npos);
  const std::size_t begin = html.find('>', html.find("waretwin-data")) + 1, end = html.find("</script>", begin);
  EXPECT_EQ(Json::parse(html.substr(begin, end - begin)), data.json) << "and it is read back as it was";
  EXPECT_NE(html.find("<script type=\"text/plain\" id=\"block:one\">Ynl0ZXM=</script>"), std::string::npos);
  EXPECT_ERROR(filled_page("<body></body>", data), "waretwin-data");
}

LoggedFrame frame(int number) {
  LoggedFrame frame;
  frame.number = number;
  frame.stamp = 1'000'000'000LL + number * 500'000'000LL;
  frame.sensor = "camera";
  frame.intrinsics = Intrinsics::checked(1280, 720, 600, 600, 640, 360);
  frame.range_m = 5.0;
  frame.X_WB = make_upright_pose(0.1 * number, 0, 0, 0);
  frame.X_WC = frame.X_WB * make_upright_pose(0, 0, 1, 0);
  frame.detections = {{"conveyor", 0.9, {10, 20, 300, 200}, 1}, {"a \"box\"", 0.5, {0, 0, 5, 5}, 0}};
  frame.objects = {test::object(1, "conveyor", 3, 0)};
  frame.colour = encoded_jpeg(cv::Mat(270, 480, CV_8UC3, cv::Scalar(40, number % 256, 90)), 80);
  frame.depth = encoded_jpeg(cv::Mat(270, 480, CV_8UC3, cv::Scalar(0, 0, 200)), 80);
  return frame;
}

TEST(FrameLog, KeepsFramesSpreadOverADriveOfAnyLength) {
  for (const int length : {1, 149, 150, 151, 700, 5000}) {
    FrameLog log;
    for (int i = 0; i < length; ++i) {
      const std::optional<int> turn = log.turn_of("camera");
      if (!turn) continue;
      LoggedFrame few;
      few.number = i;
      few.turn = *turn;
      log.add(std::move(few));
    }
    const std::vector<LoggedFrame> frames = log.take();
    EXPECT_LE(frames.size(), 150u);
    EXPECT_GE(frames.size(), std::min<std::size_t>(static_cast<std::size_t>(length), 75u)) << length;
    EXPECT_EQ(frames.front().number, 0);
    const int step = frames.size() > 1 ? frames[1].number : 1;
    for (std::size_t i = 1; i < frames.size(); ++i) EXPECT_EQ(frames[i].number - frames[i - 1].number, step);
    EXPECT_GT(frames.back().number + step, length - 1) << "to the end";
  }
}

TEST(FrameLog, KeepsFramesOfEveryCamera) {
  FrameLog log;
  for (int i = 0; i < 1000; ++i) {
    LoggedFrame few;
    few.number = i;
    few.sensor = i % 2 == 0 ? "front" : "rear";
    const std::optional<int> turn = log.turn_of(few.sensor);
    if (!turn) continue;
    few.turn = *turn;
    log.add(std::move(few));
  }
  std::map<std::string, int> counts;
  for (const LoggedFrame& kept : log.take()) ++counts[kept.sensor];
  EXPECT_EQ(counts["front"], counts["rear"]);
  EXPECT_GE(counts["front"], 37);
  EXPECT_LE(counts["front"], 75);
}

TEST(FrameLog, ComesBackFromDisk) {
  const TemporaryFolder folder;
  std::vector<LoggedFrame> frames = {frame(0), frame(4)};
  frames[1].colour.clear();
  write_frame_log(folder.path(), frames);
  const std::vector<LoggedFrame> read = read_frame_log(folder.path());
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].colour, frames[0].colour);
  EXPECT_EQ(read[1].colour, "");
  EXPECT_EQ(read[1].depth, frames[1].depth);
  EXPECT_EQ(read[1].number, 4);
  EXPECT_EQ(read[1].stamp, frames[1].stamp);
  EXPECT_TRUE(read[1].X_WC.isApprox(frames[1].X_WC, 1e-5));
  ASSERT_EQ(read[0].detections.size(), 2u);
  EXPECT_EQ(read[0].detections[1].class_name, "a \"box\"");
  EXPECT_EQ(read[0].detections[0].map_id, 1);
  EXPECT_NEAR(read[0].objects.at(0).cuboid.centre.x(), 3.0, 1e-4);
  write_frame_log(folder.path(), {frame(2)});
  EXPECT_EQ(read_frame_log(folder.path()).size(), 1u);
  EXPECT_FALSE(fs::exists(folder.path() / "frames/small/frame-0004.depth.jpg")) << "an earlier run's are taken away";
}

TEST(FrameLog, RefusesWhatIsDamagedAndReadsNothingElsewhere) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_frame_log(folder.path()).empty());
  write_file(folder.path() / "frames.jsonl", "{}\n");
  EXPECT_ERROR(read_frame_log(folder.path()), "frames.jsonl:1");
  write_frame_log(folder.path(), {frame(0)});
  std::string line = read_file(folder.path() / "frames.jsonl");
  line.replace(line.find("frame-0000.colour.jpg"), 21, "../../../etc/hostname");
  write_file(folder.path() / "frames.jsonl", line);
  EXPECT_ERROR(read_frame_log(folder.path()), "plain file name");
}

std::string small_score() {
  return R"({"schema":1,"scenario":"hall <one>","profile":"best","seed":3,"version":"0","digest":"abc",
    "objects":[{"truth_id":1,"map_id":1,"class":"conveyor","iou3d":0.9,"e_trans_m":0.01,"e_rot_deg":1.0,"visible_fraction":0.8,"counted":true}],
    "summary":{"truth":1,"mapped":1,"matched":1,"recall":1.0,"precision":1.0,"mean_iou3d":0.9,"mean_e_trans_m":0.01,"mean_e_rot_deg":1.0,
    "ap50":1.0,"map_paper":1.0},"objects_aligned":null,"summary_aligned":null,"explanations":[],"alignment":null,"detection":null,
    "surface":null,"motion":null,"trajectory":null,"rejected":{"no depth":2},"frames":{"simulated":9,"mapped":3,"dropped":6,"without_pose":0},
    "realtime_factor":1.5,"peak_rss_mb":100.0})";
}

// A run's folder without a mesh.
void write_small_run(const fs::path& folder) {
  write_file(folder / "score.json", small_score());
  write_file(folder / "cuboids.json", truth_json({test::object(1, "conveyor", 3, 0)}));
  write_file(folder / "truth.json", truth_json({test::object(1, "conveyor", 3.01, 0)}));
  std::vector<StampedPose> path, truth;
  for (int i = 0; i < 4000; ++i) {
    path.push_back({from_seconds(5.0 + 0.01 * i), make_upright_pose(0.01 * i, 0.03, 0, 0.01)});
    truth.push_back({from_seconds(5.0 + 0.01 * i), make_upright_pose(0.01 * i, 0, 0, 0)});
  }
  write_file(folder / "trajectory.tum", tum_text(path));
  write_file(folder / "trajectory_truth.tum", tum_text(truth));
  write_file(folder / "timing.csv",
             "frame,stamp_s,simulate_ms,localise_ms,detect_ms,segment_ms,associate_ms,integrate_ms,frame_ms,detections,segmented\n"
             "0,5.0,9,1,10,2,3,4,20,1,1\n1,6.0,9,3,20,2,3,4,32,1,1\n");
  write_file(folder / "topdown.png", encoded(cv::Mat(40, 60, CV_8UC3, cv::Scalar(9, 99, 199)), ".png"));
  write_frame_log(folder, {frame(0), frame(1)});
}

TEST(RunPage, HoldsWhatTheFolderHolds) {
  const TemporaryFolder folder;
  write_small_run(folder.path());
  const PageData page = run_page(folder.path());
  const Json& json = page.json;
  EXPECT_EQ(json["kind"], "run");
  EXPECT_EQ(json["title"], "hall <one>");
  EXPECT_EQ(json["path"].size(), 1500u) << "thinned";
  EXPECT_EQ(json["path"].back()[0], 39.99) << "seconds from the first pose, to the last";
  for (const Json& row : json["path_error"]) {
    EXPECT_NEAR(row[1].get<double>(), 0.03, 1e-4);
    EXPECT_NEAR(row[2].get<double>(), to_degrees(0.01), 1e-3);
  }
  EXPECT_EQ(json["timing"]["stages"][6]["mean"], 26.0);
  EXPECT_EQ(json["frames"].size(), 2u);
  EXPECT_EQ(page.blocks.at(json["frames"][1]["colour"].get<std::string>()), frame(1).colour);
  EXPECT_TRUE(json["mesh"].is_null());
  EXPECT_TRUE(json["budget"].is_null());
  EXPECT_EQ(json["paper"]["table6"].size(), 5u);
  EXPECT_EQ(page.blocks.count("topdown"), 1u);
}

TEST(RunPage, OfAMapHasNoTruth) {
  const TemporaryFolder folder;
  write_small_run(folder.path());
  for (const char* name : {"score.json", "truth.json", "trajectory_truth.tum"}) fs::remove(folder.path() / name);
  write_file(folder.path() / "map.json",
             R"({"source":"recordings/office/","profile":"best","digest":"d","frames":{"seen":5,"mapped":3,"without_pose":1}})");
  const PageData page = run_page(folder.path());
  EXPECT_EQ(page.json["title"], "map of office");
  EXPECT_TRUE(page.json["score"].is_null());
  EXPECT_TRUE(page.json["truth"].empty());
  EXPECT_TRUE(page.json["path_error"].is_null());
}

TEST(RunPage, NamesTheFileThatIsDamaged) {
  const TemporaryFolder folder;
  const auto expect_named = [&](const std::string& name, const std::string& bytes, const std::string& said) {
    write_small_run(folder.path());
    write_file(folder.path() / name, bytes);
    EXPECT_ERROR(run_page(folder.path()), said);
    fs::remove(folder.path() / name);
  };
  expect_named("score.json", "{", "score.json");
  expect_named("score.json", R"({"scenario": 5})", "score.json");
  expect_named("timing.csv", "head\n1,2,x\n", "timing.csv:2");
  expect_named("timing.csv", "head\n1,2\n", "timing.csv:2");
  expect_named("topdown.png", "no picture", "topdown.png");
  expect_named("upright.json", "{}", "upright.json");
  expect_named("cuboids.json", "[]", "cuboids.json");
}

TEST(StaticPage, IsSelfContainedEscapesNamesAndSaysWhyItIsPlain) {
  const TemporaryFolder folder;
  write_small_run(folder.path());
  write_file(folder.path() / "budget.md", "# Budget\n\n| a < b |\n");
  const std::string html = static_page(run_page(folder.path()), folder.path());
  EXPECT_NE(html.find("hall &lt;one&gt;"), std::string::npos);
  EXPECT_EQ(html.find("<one>"), std::string::npos);
  EXPECT_NE(html.find("a &lt; b"), std::string::npos);
  EXPECT_NE(html.find("data:image/jpeg;base64,/9j/"), std::string::npos) << "JPEG begins with ff d8 ff";
  EXPECT_EQ(html.find("src=\"http"), std::string::npos);
  EXPECT_NE(html.find("without Node"), std::string::npos);
  EXPECT_NE(html.find("0.9000"), std::string::npos) << "the IoU";
  EXPECT_NE(html.find("0.7925"), std::string::npos) << "the paper's";
}

Json small_study() {
  return Json::parse(R"({"schema":"waretwin-study-1","name":"mounts","description":"where the camera goes","version":"0.1.0",
    "factors":[{"name":"height","key":"sensors.cameras.camera.mount.z_m"}],
    "measures":[{"name":"mean_iou3d","text":"mean 3D IoU","better":"more","unit":""},{"name":"rms","text":"path","better":"less","unit":"m"}],
    "best_by":"mean_iou3d","baseline":0,"best":1,"halls":["agiprobot"],"seeds":[1],
    "candidates":[{"number":0,"name":"c000","values":{"height":1.2},"state":"run","feasible":true,"pareto":false,
      "measures":{"mean_iou3d":{"mean":0.7,"low":null,"high":null},"rms":null},"runs":[],"coverage_maps":["coverage/c000.png","../out.png"]},
     {"number":1,"name":"c001","values":{"height":"high"},"state":"run","feasible":true,"pareto":true,
      "measures":{"mean_iou3d":{"mean":0.8,"low":0.7,"high":0.9,"difference":{"mean":0.1,"low":0.0,"high":0.2}},"rms":{"mean":0.1,"low":0,"high":1}},
      "coverage_maps":["coverage/gone.png"]},
     {"number":2,"name":"c002","values":{"height":3},"state":"refused","feasible":false,"broken":["height < 2 does not hold: 3"]}],
    "pareto":{"measures":["mean_iou3d","rms"],"candidates":[1]},"verdict":"c001 it is","effects":[]})");
}

TEST(StudyPage, TakesPicturesThatAreThereAndNoOthers) {
  const TemporaryFolder folder;
  const fs::path study = folder.path() / "study";
  make_folder(study / "coverage");
  make_folder(study / "preview");
  write_file(study / "results.json", small_study().dump());
  write_file(study / "study.md", "x");
  const std::string picture = encoded(cv::Mat(400, 800, CV_8UC3, cv::Scalar(9, 99, 199)), ".png");
  for (const fs::path& file : {study / "coverage/c000.png", study / "preview/c001.png", folder.path() / "out.png"})
    write_file(file, picture);
  const PageData page = study_page(study);
  EXPECT_EQ(page.json["kind"], "study");
  const Json& candidates = page.json["study"]["candidates"];
  EXPECT_EQ(candidates[0]["coverage"].size(), 1u) << "not the one outside";
  EXPECT_TRUE(candidates[1]["coverage"].empty());
  EXPECT_TRUE(candidates[0]["preview"].is_null());
  const std::string preview = page.blocks.at(candidates[1]["preview"].get<std::string>());
  EXPECT_LE(cv::imdecode(std::vector<unsigned char>(preview.begin(), preview.end()), cv::IMREAD_COLOR).cols, 520);
  EXPECT_EQ(page.json["files"], Json({"study.md", "results.json"}));
  const std::string plain = static_page(page, study);
  for (const char* text : {"c001 it is", "height &lt; 2 does not hold: 3"}) EXPECT_NE(plain.find(text), std::string::npos) << text;
  // Coverage alone lies in a folder of its own, beside the previews.
  make_folder(study / "screening");
  write_file(study / "screening/results.json", small_study().dump());
  EXPECT_FALSE(study_page(study / "screening").json["study"]["candidates"][1]["preview"].is_null());
}

TEST(StudyPage, SaysWhichKeyIsWrong) {
  const TemporaryFolder folder;
  const auto expect_said = [&](const std::function<void(Json&)>& change, const std::string& said) {
    Json study = small_study();
    change(study);
    write_file(folder.path() / "results.json", study.dump());
    EXPECT_ERROR(study_page(folder.path()), "results.json");
    EXPECT_ERROR(study_page(folder.path()), said);
  };
  expect_said([](Json& s) { s["schema"] = "other"; }, "schema");
  expect_said([](Json& s) { s.erase("candidates"); }, "candidates");
  expect_said([](Json& s) { s["measures"] = 3; }, "measures");
  expect_said([](Json& s) { s["candidates"][1]["state"] = "maybe"; }, "c001, state");
  expect_said([](Json& s) { s["candidates"][0].erase("measures"); }, "c000, measures");
  expect_said([](Json& s) { s["candidates"][0]["runs"] = Json::array({Json::object()}); }, "c000, runs");
  expect_said([](Json& s) { s["pareto"] = true; }, "pareto");
  write_file(folder.path() / "results.json", "nothing");
  EXPECT_ERROR(study_page(folder.path()), "results.json");
}

// Files of a folder may be damaged in any way: a page is made, or one line says what is wrong.
TEST(ReportFiles, AreReadOrRefusedWhateverTheirBytes) {
  const TemporaryFolder folder;
  const fs::path dir = folder.path() / "run", study = folder.path() / "study";
  make_folder(dir);
  make_folder(study);
  write_small_run(dir);
  SurfaceMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0.5f}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.colours.assign(3, {1, 2, 3});
  mesh.labels = {0, 4, 4};
  mesh.triangles = {{0, 1, 2}};
  write_ply(dir / "map.ply", mesh);
  write_cloud_ply(dir / "cloud.ply", mesh);
  write_surface_errors(dir, mesh.vertices, {0.0f, 0.1f, 0.2f});
  fs::remove(dir / "trajectory.tum");  // long, and read by others' code
  write_file(study / "results.json", small_study().dump());
  std::mt19937 random(11);
  const auto below = [&random](std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random); };
  for (const fs::path& file : {dir / "map.ply", dir / "cloud.ply", dir / "surface_error.ply", dir / "frames.jsonl", dir / "score.json",
                               dir / "timing.csv", study / "results.json"}) {
    const std::string good = read_file(file);
    const bool is_text = file.extension() != ".ply";
    for (int i = 0; i < 150; ++i) {
      std::string bytes = good;
      for (std::size_t k = 0; k <= below(3); ++k) {
        switch (below(4)) {
          case 0:
            bytes[below(bytes.size())] = static_cast<char>(is_text ? ' ' + below(95) : below(256));
            break;
          case 1:
            bytes.erase(below(bytes.size()), 1 + below(8));
            break;
          case 2:
            bytes.insert(below(bytes.size()), bytes.substr(below(bytes.size()), 1 + below(12)));
            break;
          default: {  // a value of another type
            const std::size_t number = bytes.find_first_of("0123456789", below(bytes.size()));
            if (number != std::string::npos) bytes.replace(number, 1, below(2) == 0 ? "null" : "\"x\"");
          }
        }
      }
      write_file(file, bytes);
      try {
        const PageData page = file.parent_path() == study ? study_page(study) : run_page(dir);
        EXPECT_FALSE(static_page(page, dir).empty());
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      } catch (const std::exception& other) {
        ADD_FAILURE() << file.filename() << ": " << other.what() << "\n" << (is_text ? bytes : "");
        break;
      }
    }
    write_file(file, good);
  }
}

TEST(ReportKind, IsKnownByTheFiles) {
  const TemporaryFolder folder;
  const fs::path dir = folder.path();
  EXPECT_ERROR(report_kind(dir / "none"), "does not exist");
  EXPECT_ERROR(report_kind(dir), "run, a study or a dataset");
  write_file(dir / "file", "");
  EXPECT_ERROR(report_kind(dir / "file"), "no folder");
  write_file(dir / "trajectory.tum", "");
  EXPECT_ERROR(report_kind(dir), "neither score.json nor map.json");
  write_file(dir / "map.json", "");
  EXPECT_EQ(report_kind(dir), ReportKind::kRun) << "of a laser log";
  fs::remove(dir / "map.json");
  write_file(dir / "truth.json", "");
  EXPECT_ERROR(report_kind(dir), "did not finish");
  write_file(dir / "score.json", "");
  write_file(dir / "cuboids.json", "");
  EXPECT_EQ(report_kind(dir), ReportKind::kRun);
  write_file(dir / "dataset.yaml", "");
  EXPECT_EQ(report_kind(dir), ReportKind::kDataset);
  EXPECT_ERROR(dataset_page(dir), "not finished");
  write_file(dir / "results.json", "");
  EXPECT_EQ(report_kind(dir), ReportKind::kStudy);
}

TEST(Report, IsWrittenWithOrWithoutTheViewer) {
  const TemporaryFolder folder;
  write_small_run(folder.path());
  ASSERT_EQ(setenv("WARETWIN_VIEWER", "none", 1), 0);
  EXPECT_TRUE(write_report(folder.path()).plain);
  EXPECT_NE(read_file(folder.path() / "report.html").find("plain page"), std::string::npos);
  write_file(folder.path() / "page.html", "<body><!--waretwin-data--></body>");
  ASSERT_EQ(setenv("WARETWIN_VIEWER", (folder.path() / "page.html").c_str(), 1), 0);
  const ReportSummary summary = write_report(folder.path());
  EXPECT_FALSE(summary.plain);
  EXPECT_EQ(summary.bytes, fs::file_size(folder.path() / "report.html"));
  ASSERT_EQ(setenv("WARETWIN_VIEWER", "/no/such/page", 1), 0);
  EXPECT_ERROR(write_report(folder.path()), "WARETWIN_VIEWER");
  unsetenv("WARETWIN_VIEWER");
}

}  // namespace
}  // namespace waretwin
