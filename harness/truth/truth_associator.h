// Association by the truth: a mapped object is the true one whose pixels it is made of, and carries its id.
#pragma once

#include <map>
#include <memory>

#include "mapper/associate/associator.h"
#include "mapper/mapper_config.h"
#include "sim/simulated_stream.h"

namespace waretwin {

// A segmented object belongs to the true object of its detection's class that most of its pixels show. Where none shows any, it belongs
// to none. Points and cuboid are updated as the mapper's own associator does it; profile voxbloxpp's as profile paper does (points are
// accumulated), since its own way is to find segments again by labels that here are true ids.
class TruthAssociator : public Associator {
 public:
  // The stream must outlive the associator; its newest frame is the one that is associated.
  TruthAssociator(const SimulatedStream& stream, const MapperConfig& config);
  ~TruthAssociator() override;
  std::vector<int> associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context, ObjectList& map) override;
  std::vector<std::pair<int, int>> take_merges() override;
  void finish(ObjectList& map, const TsdfVolume& volume) override;

 private:
  struct Track;
  const SimulatedStream& stream_;
  MapperConfig config_;
  std::map<int, std::unique_ptr<Track>> tracks_;  // by true id
  std::vector<std::pair<int, int>> merges_;
};

// The id among `objects` of class `class_name` that most of the pixels (v * width + u) show; 0 where none does. Equal counts: the smaller
// id.
int true_id_of(const std::vector<int>& pixels, const cv::Mat& instances, const std::vector<TrueObject>& objects,
               const std::string& class_name);

}  // namespace waretwin
