// Association by the truth: a mapped object is the true one whose pixels it is made of, and carries its id.
#pragma once

#include <map>
#include <memory>

#include "mapper/associate/associate_config.h"
#include "mapper/associate/associator.h"
#include "sim/simulated_stream.h"

namespace waretwin {

// A segmented object belongs to the true object of its detection's class that most of its pixels show. Where none shows any, it belongs
// to none. Points and cuboid are updated as the mapper's own associator does it.
class TruthAssociator : public Associator {
 public:
  // The stream must outlive the associator; its newest frame is the one that is associated.
  TruthAssociator(const SimulatedStream& stream, const AssociateConfig& config);
  ~TruthAssociator() override;
  std::vector<int> associate(const std::vector<SegmentedObject>& objects, const AssociationContext& context, ObjectList& map) override;

 private:
  struct Track;
  const SimulatedStream& stream_;
  AssociateConfig config_;
  std::map<int, std::unique_ptr<Track>> tracks_;  // by true id
};

// The id among `objects` of class `class_name` that most of the pixels (v * width + u) show; 0 where none does. Equal counts: the smaller
// id.
int true_id_of(const std::vector<int>& pixels, const cv::Mat& instances, const std::vector<TrueObject>& objects,
               const std::string& class_name);

}  // namespace waretwin
