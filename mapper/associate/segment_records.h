// What frames said about the mapped segments: of which object instance each is a part, and of which class that is (Grinvald et al. 2019,
// section III-D). All counts are of frames.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace waretwin {

class SegmentRecords {
 public:
  // An instance holds a segment only when it was seen with it in more than background_factor times the frames without it.
  explicit SegmentRecords(double background_factor) : background_factor_(background_factor) {}

  // The mapped instance that each of `instances` things in a frame is; members holds (mapped segment, thing). A thing is the instance with
  // which one of its segments was seen most often: pairs by falling count, each instance once a frame. 0 = none of them.
  std::vector<int> match_instances(const std::vector<std::pair<int, std::size_t>>& members, std::size_t instances) const;

  // One frame shows the segment, as part of an instance (0: of none) that the frame calls class_name.
  void see(int segment, int instance, const std::string& class_name, int frames = 1);

  // From now on, what was said of `from` holds for `to`: they are one segment.
  void merge(int from, int to);

  int instance_of(int segment) const;  // the one seen most often, of equal ones the oldest; 0 = background
  // The instances that hold segments, with their segments, both ascending.
  std::map<int, std::vector<int>> instances() const;
  // The class that most frames saw on these segments; of equal ones the first by name.
  std::string class_of(const std::vector<int>& segments) const;
  std::vector<int> segments() const;  // ascending

 private:
  struct Record {
    int frames = 0;
    std::map<int, int> instances;
    std::map<std::string, int> classes;
  };
  double background_factor_;
  std::map<int, Record> records_;
};

}  // namespace waretwin
