#include "harness/truth/truth_associator.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "mapper/stages.h"

namespace waretwin {

namespace {

// The mapper's own update of an object, with conditions that always hold.
MapperConfig always(MapperConfig config) {
  config.associate.max_frame_gap = 0;
  config.associate.min_iou_2d = -1.0;
  config.associate.min_correlation = -1.0e9;
  config.associate.min_iou_3d = -1.0;
  config.evidence.min_overlap = -1.0;
  config.evidence.min_presence = 0.0;  // a track only hears of the frames that show its object
  // Segments are found again in a volume that they labelled, here true ids label it: their points are accumulated instead.
  if (config.objects == "segments") config.objects = "points";
  return config;
}

}  // namespace

struct TruthAssociator::Track {
  std::unique_ptr<Associator> update;
  ObjectList object;  // one at most
};

TruthAssociator::TruthAssociator(const SimulatedStream& stream, const MapperConfig& config) : stream_(stream), config_(always(config)) {}

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
    if (!track) track.reset(new Track{make_associator(config_), {}});
    track->update->associate({object}, context, track->object);
    if (track->object.empty()) {  // not enough of it to be an object yet
      ids.back() = 0;
      continue;
    }
    WARETWIN_CHECK(track->object.size() == 1, "a track is one object");

    auto place = std::find_if(map.begin(), map.end(), [id](const MappedObject& mapped) { return mapped.id >= id; });
    if (place == map.end() || place->id != id) place = map.insert(place, MappedObject{});
    *place = track->object.front();
    place->id = id;
  }
  return ids;
}

std::vector<std::pair<int, int>> TruthAssociator::take_merges() { return std::exchange(merges_, {}); }

void TruthAssociator::finish(ObjectList& map, const TsdfVolume& volume) {
  for (auto& [id, track] : tracks_) {
    const auto mapped = std::find_if(map.begin(), map.end(), [id = id](const MappedObject& m) { return m.id == id; });
    if (mapped == map.end()) continue;
    track->update->finish(track->object, volume);
    if (track->object.empty()) {
      merges_.emplace_back(id, 0);
      map.erase(mapped);
    } else {
      *mapped = track->object.front();
      mapped->id = id;
    }
  }
}

}  // namespace waretwin
