#include "harness/truth/truth_associator.h"

#include <algorithm>

#include "core/error.h"
#include "mapper/associate/paper_associator.h"

namespace waretwin {

namespace {

// The mapper's own update of an object, with conditions that always hold.
AssociateConfig always(AssociateConfig config) {
  config.max_frame_gap = 0;
  config.min_iou_2d = -1.0;
  config.min_correlation = -1.0e9;
  config.min_iou_3d = -1.0;
  return config;
}

}  // namespace

struct TruthAssociator::Track {
  PaperAssociator update;
  ObjectList object;  // one at most
};

TruthAssociator::TruthAssociator(const SimulatedStream& stream, const AssociateConfig& config) : stream_(stream), config_(always(config)) {}

TruthAssociator::~TruthAssociator() = default;

int true_id_of(const std::vector<int>& pixels, const cv::Mat& instances, const std::vector<TrueObject>& objects,
               const std::string& class_name) {
  std::map<int, int> counts;
  for (const int pixel : pixels) ++counts[instances.at<std::uint16_t>(pixel / instances.cols, pixel % instances.cols)];
  int best = 0, most = 0;
  for (const TrueObject& object : objects) {
    const auto found = counts.find(object.id);
    if (object.class_name != class_name || found == counts.end() || found->second <= most) continue;
    best = object.id;
    most = found->second;
  }
  return best;
}

std::vector<int> TruthAssociator::associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context,
                                            ObjectList& map) {
  const FrameTruth& truth = stream_.last_frame_truth();
  WARETWIN_CHECK(truth.stamp == context.stamp, "the truth associator is asked for the stream's newest frame");
  std::vector<int> ids;
  for (const SegmentedObject& object : objects) {
    const int id =
        object.points_W.empty() ? 0 : true_id_of(object.pixels, truth.instances, stream_.scene().objects, object.detection.class_name);
    ids.push_back(id);
    if (id == 0) continue;
    auto& track = tracks_[id];
    if (!track) track.reset(new Track{PaperAssociator(config_), {}});
    track->update.associate({object}, context, track->object);
    WARETWIN_CHECK(track->object.size() == 1, "a track is one object");

    auto place = std::find_if(map.begin(), map.end(), [id](const MappedObject& mapped) { return mapped.id >= id; });
    if (place == map.end() || place->id != id) place = map.insert(place, MappedObject{});
    *place = track->object.front();
    place->id = id;
  }
  return ids;
}

}  // namespace waretwin
