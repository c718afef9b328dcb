#include "mapper/mapper_config.h"

#include <gtest/gtest.h>

#include "core/config.h"
#include "core/error.h"

namespace waretwin {
namespace {

// The constants that stand in the paper, each with its place in the text.
TEST(MapperConfig, PaperHasThePapersConstants) {
  const MapperConfig paper = MapperConfig::make("paper");
  EXPECT_EQ(paper.rate_hz, 1.0);                    // section 4.3
  EXPECT_EQ(paper.segment.cluster_fraction, 0.7);   // section 3.2, "at least 70 %"
  EXPECT_EQ(paper.associate.max_frame_gap, 10);     // section 3.3, eta < 10
  EXPECT_EQ(paper.associate.min_iou_2d, 0.5);       // section 3.3
  EXPECT_EQ(paper.associate.min_correlation, 0.3);  // section 3.3
  EXPECT_EQ(paper.associate.min_iou_3d, 0.5);       // section 3.3
  EXPECT_EQ(paper.associate.merge_iou_3d, 0.8);     // section 3.3
  EXPECT_EQ(paper.integrate.voxel_m, 0.02);         // section 4.2
}

// Those of the authors' published settings.
TEST(MapperConfig, VoxbloxppHasItsAuthorsConstants) {
  const MapperConfig config = MapperConfig::make("voxbloxpp");
  EXPECT_EQ(config.objects, "segments");
  EXPECT_EQ(config.integrate.method, "rays");
  EXPECT_EQ(config.integrate.voxel_m, MapperConfig::make("paper").integrate.voxel_m);
  EXPECT_EQ(config.rate_hz, 1.0);
  EXPECT_EQ(config.geometric.min_convexity, 0.97);
  EXPECT_EQ(config.geometric.discontinuity_share, 0.01);
  EXPECT_EQ(config.segments.min_label_voxels, 20);
  EXPECT_EQ(config.segments.merging_min_overlap_ratio, 0.15);
  EXPECT_EQ(config.segments.merging_min_frame_count, 3);
}

TEST(MapperConfig, WindowsAreOdd) {
  MapperConfig config = MapperConfig::make("voxbloxpp");
  EXPECT_THROW(apply_settings({{"geometric.normal_window_px", "8"}}, [&](Fields& f) { config.visit(f); }), Error);
  EXPECT_THROW(apply_settings({{"geometric.convexity_window_px", "4"}}, [&](Fields& f) { config.visit(f); }), Error);
}

TEST(MapperConfig, AProfileLeavesWhereBoxesAndPosesComeFrom) {
  MapperConfig config = MapperConfig::make("best");
  config.detector = "yolo";
  config.model = "mine";
  config.poses = "odometry";
  apply_settings({{"profile", "paper"}}, [&](Fields& f) { config.visit(f); });
  EXPECT_EQ(config.objects, MapperConfig::make("paper").objects);
  EXPECT_EQ(config.detector, "yolo");
  EXPECT_EQ(config.model, "mine");
  EXPECT_EQ(config.poses, "odometry");
}

TEST(MapperConfig, AProfileSetsAllThatDoesNotFollowIt) {
  MapperConfig config = MapperConfig::make("paper");
  apply_settings({{"profile", "best"}, {"rate_hz", "5"}}, [&](Fields& f) { config.visit(f); });
  EXPECT_EQ(config.rate_hz, 5.0);
  EXPECT_EQ(config.objects, "evidence");
}

TEST(MapperConfig, ReadsBackWhatItWrites) {
  MapperConfig config = MapperConfig::make("paper");
  config.associate.min_iou_2d = 0.1 + 0.2;
  config.detect.classes = {"conveyor", "chair"};
  const std::string yaml = write_config([&](Fields& f) { config.visit(f); });
  MapperConfig again;
  read_config_text(yaml, "config.yaml", [&](Fields& f) { again.visit(f); });
  EXPECT_EQ(again.associate.min_iou_2d, config.associate.min_iou_2d);
  EXPECT_EQ(again.detect.classes, config.detect.classes);
  EXPECT_EQ(again.profile, "paper");
  EXPECT_EQ(write_config([&](Fields& f) { again.visit(f); }), yaml);
}

TEST(MapperConfig, NamesTheProfilesItKnows) {
  try {
    MapperConfig::make("papr");
    FAIL() << "must throw";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("paper, best or voxbloxpp"), std::string::npos);
  }
}

}  // namespace
}  // namespace waretwin
