// A ROS 1 bag as a recording. Compiled where librosbag-storage and tf2 were found.
#include <console_bridge/console.h>
#include <nav_msgs/Odometry.h>
#include <ros/serialization.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/LaserScan.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "core/error.h"
#include "sensors/recordings/bag_pictures.h"
#include "sensors/recordings/bag_transforms.h"
#include "sensors/recordings/ros_bag.h"
#include "sensors/recordings/stamped_files.h"

namespace waretwin {

namespace fs = std::filesystem;

namespace {

constexpr const char* kImage = "sensor_msgs/Image";
constexpr const char* kCompressed = "sensor_msgs/CompressedImage";
constexpr const char* kCameraInfo = "sensor_msgs/CameraInfo";
constexpr const char* kLaserScan = "sensor_msgs/LaserScan";
constexpr const char* kOdometry = "nav_msgs/Odometry";

constexpr const char* kNone = "none";  // as the name of a topic: not to be read

Stamp stamp_of_time(const ros::Time& time) { return static_cast<Stamp>(time.sec) * kNanosecondsPerSecond + time.nsec; }

bool ends_with(const std::string& text, const std::string& tail) {
  return text.size() >= tail.size() && text.compare(text.size() - tail.size(), tail.size(), tail) == 0;
}

template <class T, class Predicate>
void erase_if(std::vector<T>& values, const Predicate& predicate) {
  values.erase(std::remove_if(values.begin(), values.end(), predicate), values.end());
}

// The library's faults as ours.
template <class F>
auto guarded(const fs::path& file, const F& work) -> decltype(work()) {
  try {
    return work();
  } catch (const rosbag::BagUnindexedException&) {
    throw Error(file, "has no index, as after a recording that was cut off; expected an indexed bag (rosbag reindex makes one)");
  } catch (const rosbag::BagIOException& e) {
    throw Error(file, "ends too early or cannot be read (" + std::string(e.what()) +
                          "); expected a whole ROS 1 bag (rosbag reindex mends one that was cut off)");
  } catch (const ros::Exception& e) {
    throw Error(file, "is no ROS 1 bag that can be read: " + std::string(e.what()));
  } catch (const std::bad_alloc&) {
    throw Error(file, "is no ROS 1 bag that can be read: it announces more bytes than there is memory");
  }
}

// The file, open for as long as frames are to be loaded. The library's reading is not for several threads at once.
class OpenBag {
 public:
  explicit OpenBag(const fs::path& file) : file_(file) {
    guarded(file_, [&] { bag_.open(file_.string(), rosbag::bagmode::Read); });
  }
  const fs::path& file() const { return file_; }
  const rosbag::Bag& bag() const { return bag_; }

  template <class Message>
  boost::shared_ptr<Message> read(const rosbag::MessageInstance& instance) const {
    const std::scoped_lock lock(mutex_);
    const auto message = guarded(file_, [&] { return instance.instantiate<Message>(); });
    if (!message) {
      throw Error(file_, instance.getTopic() + ": holds another version of " + instance.getDataType() + "; expected that of ROS Noetic");
    }
    return message;
  }

 private:
  fs::path file_;
  rosbag::Bag bag_;
  mutable std::mutex mutex_;
};

// A picture's place in the bag.
struct Picture {
  Stamp stamp = 0;
  std::shared_ptr<const rosbag::MessageInstance> instance;  // the library's own cannot be assigned
};

// Which topics there are, and which of them is meant.
class Topics {
 public:
  Topics(const fs::path& file, rosbag::View& view) : file_(file) {
    for (const rosbag::ConnectionInfo* connection : view.getConnections()) types_[connection->topic] = connection->datatype;
  }

  const std::string& type(const std::string& name) const { return types_.at(name); }

  // Those of the types, in order of their names.
  std::vector<std::string> of(const std::set<std::string>& types) const {
    std::vector<std::string> names;
    for (const auto& [name, type] : types_) {
      if (types.count(type) > 0) names.push_back(name);
    }
    return names;
  }

  // The topic that the key names, or the only candidate; empty where there is none and none is asked for.
  // What `preset` names is only preferred.
  std::string choose(const std::string& key, const std::string& named, const std::set<std::string>& types,
                     const std::vector<std::string>& candidates, const std::string& preset = "") const {
    if (!named.empty()) {
      // A preset's raw topic may have been recorded compressed alone.
      for (const char* suffix : {"", "/compressed", "/compressedDepth"}) {
        const auto found = types_.find(named + suffix);
        if (found != types_.end() && types.count(found->second) > 0) return found->first;
      }
      if (named == preset) return choose(key, "", types, candidates);
      const auto found = types_.find(named);
      throw Error(file_, "recording.bag." + key + ": the topic " + named +
                             (found == types_.end() ? " is not in the bag" : " holds " + found->second) + "; expected " + list(types) +
                             " (there " + (candidates.size() == 1 ? "is " : "are ") + list(candidates) + ")");
    }
    if (candidates.size() > 1) {
      throw Error(file_, "holds " + std::to_string(candidates.size()) + " topics that may be meant: " + list(candidates) +
                             "; expected one of them as recording.bag." + key);
    }
    return candidates.empty() ? "" : candidates.front();
  }

 private:
  template <class Names>
  static std::string list(const Names& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text.empty() ? "none" : text;
  }

  fs::path file_;
  std::map<std::string, std::string> types_;
};

class BagReader {
 public:
  BagReader(const fs::path& file, const RecordingConfig& config)
      : config_(config), bag_(std::make_shared<OpenBag>(file)), view_(bag_->bag()), topics_(file, view_) {}

  RecordingContents read() {
    guarded(bag_->file(), [&] {
      choose_topics();
      read_messages();
    });
    const auto expect = [&](const auto& values, const std::string& what, const std::string& topic, const std::string& key = "") {
      expect_times(values, bag_->file(), what + " (" + topic + ")", key.empty() ? "" : "or recording.bag." + key + "=none");
    };
    expect(colours_, "pictures", colour_topic_);
    expect(depths_, "depth images", depth_topic_);
    expect(natives_, "native depth images", native_topic_, "native_depth_topic");
    expect(contents_.scans, "scans", laser_topic_, "laser_topic");
    expect(contents_.readings, "odometry readings", odometry_topic_, "odometry_topic");
    sort_and_thin(colours_, "pictures");
    sort_and_thin(depths_, "depth images");
    sort_and_thin(natives_, "native depth images");
    sort_and_thin(contents_.scans, "scans");
    sort_and_thin(contents_.readings, "odometry readings");
    pair_pictures();
    if (contents_.frames.empty() && contents_.scans.empty()) {
      throw Error(bag_->file(),
                  "holds neither pictures with depth nor scans; expected topics of sensor_msgs/Image or sensor_msgs/LaserScan");
    }
    mount_sensors();
    find_poses();
    for (const auto& [what, topic] : {std::pair{"pictures", colour_topic_},
                                      {"depth", depth_topic_},
                                      {"own images of the depth camera", native_topic_},
                                      {"scans", laser_topic_},
                                      {"odometry", odometry_topic_}}) {
      if (!topic.empty()) contents_.sources.push_back(std::string(what) + ": " + topic);
    }
    contents_.laser_rate_hz = median_rate_hz(contents_.scans);
    contents_.rate_hz = median_rate_hz(contents_.frames);
    return std::move(contents_);
  }

 private:
  void choose_topics() {
    const RosBagConfig& names = config_.bag;
    const RosBagConfig preset = RosBagConfig::of_preset(names.preset);
    std::vector<std::string> colours, depths, others;
    for (const std::string& name : topics_.of({kImage, kCompressed})) {
      std::string encoding;
      switch (kind_of(name, encoding)) {
        case Kind::kColour:
          colours.push_back(name);
          break;
        case Kind::kDepth:
          depths.push_back(name);
          break;
        case Kind::kOther:
          others.push_back(name + " (" + encoding + ")");
          break;
      }
    }
    colour_topic_ = topics_.choose("colour_topic", names.colour_topic, {kImage, kCompressed}, without_twins(colours), preset.colour_topic);
    depth_topic_ =
        topics_.choose("depth_topic", names.depth_topic, {kImage, kCompressed}, registered_ones(without_twins(depths)), preset.depth_topic);
    if (names.laser_topic != kNone) {
      laser_topic_ = topics_.choose("laser_topic", names.laser_topic, {kLaserScan}, topics_.of({kLaserScan}));
    }
    if (names.odometry_topic != kNone) {
      odometry_topic_ = topics_.choose("odometry_topic", names.odometry_topic, {kOdometry}, topics_.of({kOdometry}));
    }
    if (colour_topic_.empty() && !depth_topic_.empty()) {
      std::string there;
      for (const std::string& other : others) there += (there.empty() ? "" : ", ") + other;
      throw Error(bag_->file(), "holds depth (" + depth_topic_ +
                                    ") but no picture that is read; expected bgr8, rgb8, bgra8, rgba8, mono8 or "
                                    "compressed ones (there " +
                                    (others.size() == 1 ? "is " : "are ") + (there.empty() ? "none" : there) + ")");
    }
    if (colour_topic_.empty()) return;
    if (depth_topic_ == colour_topic_)
      throw Error(bag_->file(), "recording.bag.depth_topic is the colour topic, " + colour_topic_ + "; expected depth");
    if (depth_topic_.empty()) {
      if (laser_topic_.empty())
        throw Error(bag_->file(), "holds pictures (" + colour_topic_ + ") but no depth; expected recording.bag.depth_topic");
      contents_.remarks.push_back("pictures (" + colour_topic_ + ") are left out: the bag holds no depth");
      colour_topic_.clear();
      return;
    }
    choose_native_topic(without_twins(depths));
    std::vector<std::string> infos = topics_.of({kCameraInfo});
    const std::string beside = info_beside(colour_topic_);
    if (std::find(infos.begin(), infos.end(), beside) != infos.end()) infos = {beside};
    info_topic_ = topics_.choose("colour_info_topic", names.colour_info_topic, {kCameraInfo}, infos, preset.colour_info_topic);
    if (info_topic_.empty() && config_.intrinsics.empty() && !has_calibration_beside()) {
      throw Error(bag_->file(), "holds no sensor_msgs/CameraInfo; expected one, recording.intrinsics, or a recording.yaml beside the bag");
    }
    depth_info_topic_ = info_beside(depth_topic_);
  }

  // The depth camera's own images are of the same device as the pictures: /front/camera/depth/.. goes with /front/camera/rgb/..
  void choose_native_topic(std::vector<std::string> depths) {
    const std::string& named = config_.bag.native_depth_topic;
    if (named == kNone) return;
    const auto device = [](const std::string& topic) {
      const std::string camera = info_beside(topic);
      return camera.substr(0, camera.rfind('/', camera.rfind('/') - 1));
    };
    erase_if(depths, [&](const std::string& name) { return name == depth_topic_ || device(name) != device(colour_topic_); });
    if (depths.size() != 1 && named.empty()) return;
    native_topic_ = topics_.choose("native_depth_topic", named, {kImage, kCompressed}, depths);
    native_info_topic_ = info_beside(native_topic_);
  }

  enum class Kind { kColour, kDepth, kOther };

  // By the first message's encoding.
  Kind kind_of(const std::string& topic, std::string& encoding) const {
    rosbag::View view(bag_->bag(), rosbag::TopicQuery(topic));
    if (view.size() == 0) return Kind::kOther;
    if (topics_.type(topic) == kImage) {
      encoding = bag_->read<sensor_msgs::Image>(*view.begin())->encoding;
      return is_depth_encoding(encoding) ? Kind::kDepth : is_colour_encoding(encoding) ? Kind::kColour : Kind::kOther;
    }
    const std::string format = bag_->read<sensor_msgs::CompressedImage>(*view.begin())->format;
    return is_depth_encoding(format.substr(0, format.find(';'))) ? Kind::kDepth : Kind::kColour;
  }

  // A picture that is there raw is not needed compressed.
  static std::vector<std::string> without_twins(std::vector<std::string> topics) {
    const std::set<std::string> all(topics.begin(), topics.end());
    erase_if(topics, [&](const std::string& name) {
      for (const std::string suffix : {"/compressed", "/compressedDepth"}) {
        if (ends_with(name, suffix) && all.count(name.substr(0, name.size() - suffix.size())) > 0) return true;
      }
      return false;
    });
    return topics;
  }

  // Of several depth topics those whose name says that they are in the colour picture's view.
  static std::vector<std::string> registered_ones(const std::vector<std::string>& topics) {
    std::vector<std::string> registered;
    for (const std::string& name : topics) {
      for (const char* word : {"registered", "depth_to_rgb", "aligned"}) {
        if (name.find(word) == std::string::npos) continue;
        registered.push_back(name);
        break;
      }
    }
    return registered.empty() ? topics : registered;
  }

  // /CAMERA/camera_info of /CAMERA/image_raw or /CAMERA/image_raw/compressed.
  static std::string info_beside(const std::string& topic) {
    std::string name = topic;
    for (const std::string suffix : {"/compressed", "/compressedDepth"}) {
      if (ends_with(name, suffix)) name.resize(name.size() - suffix.size());
    }
    return name.substr(0, name.rfind('/')) + "/camera_info";
  }

  void read_messages() {
    const Stamp delay = depth_delay(config_);
    for (const rosbag::MessageInstance& instance : view_) {
      const std::string& topic = instance.getTopic();
      if (topic == colour_topic_) {
        const std_msgs::Header header = header_of(instance);
        if (camera_frame_.empty()) camera_frame_ = frame_name(header.frame_id);
        colours_.push_back({stamp_of_time(header.stamp), std::make_shared<const rosbag::MessageInstance>(instance)});
      } else if (topic == depth_topic_) {
        const std_msgs::Header header = header_of(instance);
        if (depth_frame_.empty()) depth_frame_ = frame_name(header.frame_id);
        depths_.push_back({stamp_of_time(header.stamp) + delay, std::make_shared<const rosbag::MessageInstance>(instance)});
      } else if (topic == native_topic_) {
        const std_msgs::Header header = header_of(instance);
        if (native_frame_.empty()) native_frame_ = frame_name(header.frame_id);
        natives_.push_back({stamp_of_time(header.stamp) + delay, std::make_shared<const rosbag::MessageInstance>(instance)});
      } else if (topic == native_info_topic_) {
        if (!native_info_) native_info_ = *bag_->read<sensor_msgs::CameraInfo>(instance);
      } else if (topic == depth_info_topic_ && topic != info_topic_) {
        if (!depth_info_) depth_info_ = *bag_->read<sensor_msgs::CameraInfo>(instance);
      } else if (topic == info_topic_) {
        if (!first_info_) take_info(*(first_info_ = *bag_->read<sensor_msgs::CameraInfo>(instance)));
      } else if (topic == laser_topic_) {
        take_scan(*bag_->read<sensor_msgs::LaserScan>(instance));
      } else if (topic == odometry_topic_) {
        take_odometry(*bag_->read<nav_msgs::Odometry>(instance));
      } else if (frame_name(topic) == "tf" || frame_name(topic) == "tf_static") {
        take_tf(instance, frame_name(topic) == "tf_static");
      }
    }
    contents_.has_laser = !laser_topic_.empty();
    contents_.has_odometry = !odometry_topic_.empty();
  }

  // The header alone, without the pixels behind it.
  static std_msgs::Header header_of(const rosbag::MessageInstance& instance) {
    std::vector<std::uint8_t> bytes(instance.size());
    ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    instance.write(out);
    ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    std_msgs::Header header;
    ros::serialization::deserialize(in, header);
    return header;
  }

  void take_info(const sensor_msgs::CameraInfo& info) {
    const auto finite = [](const auto& numbers) {
      return std::all_of(numbers.begin(), numbers.end(), [](double v) { return std::isfinite(v); });
    };
    if (!finite(info.K) || !finite(info.D) || !finite(info.P)) {
      throw Error(bag_->file(), info_topic_ + ": holds numbers that are not finite; expected a calibrated camera");
    }
    if (!(info.K[0] > 0.0 && info.K[4] > 0.0)) {
      if (config_.intrinsics.empty() && !has_calibration_beside()) {
        throw Error(bag_->file(), info_topic_ + ": says a focal length of " + std::to_string(info.K[0]) +
                                      "; expected a calibrated camera, or recording.intrinsics");
      }
      return;
    }
    contents_.intrinsics = {info.K[0], info.K[4], info.K[2], info.K[5]};
    const bool named_rectified = colour_topic_.find("rect") != std::string::npos;
    const bool rectified = config_.bag.rectified == "yes" || (config_.bag.rectified == "auto" && named_rectified);
    if (rectified) {
      // What image_proc makes is in P's view.
      if (info.P[0] > 0.0 && info.P[5] > 0.0) contents_.intrinsics = {info.P[0], info.P[5], info.P[2], info.P[6]};
      return;
    }
    const std::optional<Distortion> distortion = distortion_of(info);
    if (!distortion) {
      throw Error(bag_->file(), info_topic_ + ": has the distortion model '" + info.distortion_model +
                                    "'; expected plumb_bob or rational_polynomial, or recording.bag.rectified=yes");
    }
    contents_.distortion = *distortion;
  }

  // Nothing for models of other kinds (fisheye).
  static std::optional<Distortion> distortion_of(const sensor_msgs::CameraInfo& info) {
    const bool any = std::any_of(info.D.begin(), info.D.end(), [](double v) { return v != 0.0; });
    if (any && info.distortion_model != "plumb_bob" && info.distortion_model != "rational_polynomial") return std::nullopt;
    const auto d = [&](std::size_t i) { return i < info.D.size() ? info.D[i] : 0.0; };
    return Distortion{d(0), d(1), d(4), d(5), d(6), d(7), d(2), d(3)};
  }

  void take_scan(const sensor_msgs::LaserScan& message) {
    if (laser_frame_.empty()) laser_frame_ = frame_name(message.header.frame_id);
    if (!std::isfinite(message.angle_min) || !std::isfinite(message.angle_increment) || !(message.time_increment >= 0.0f) ||
        !(message.time_increment < 10.0f)) {
      ++bad_scans_;
      return;
    }
    LaserScan scan;
    scan.stamp = stamp_of_time(message.header.stamp);
    scan.sensor = "laser";
    scan.angle_min = static_cast<double>(message.angle_min);
    scan.angle_increment = static_cast<double>(message.angle_increment);
    scan.beam_interval = std::llround(static_cast<double>(message.time_increment) * 1e9);
    scan.range_min = static_cast<double>(message.range_min);
    scan.range_max = static_cast<double>(message.range_max);
    scan.ranges = message.ranges;
    for (float& range : scan.ranges) {
      if (!(range >= message.range_min && range <= message.range_max) || !std::isfinite(range)) range = 0.0f;
    }
    contents_.scans.push_back(std::move(scan));
  }

  void take_odometry(const nav_msgs::Odometry& message) {
    const auto& p = message.pose.pose.position;
    const auto& q = message.pose.pose.orientation;
    const Eigen::Quaterniond turn(q.w, q.x, q.y, q.z);
    if (!(turn.norm() > 0.5) || !std::isfinite(p.x) || !std::isfinite(p.y)) {
      ++bad_readings_;
      return;
    }
    const bool planar = q.x == 0.0 && q.y == 0.0;
    Pose X_OB = Pose::Identity();
    X_OB.linear() = turn.normalized().toRotationMatrix();
    const double yaw = planar ? 2.0 * std::atan2(q.z, q.w) : yaw_of(X_OB);
    contents_.readings.push_back(
        {stamp_of_time(message.header.stamp), "odometry", make_upright_pose(p.x, p.y, 0.0, std::round(yaw * 1e9) / 1e9)});
  }

  void take_tf(const rosbag::MessageInstance& instance, bool fixed) {
    // The old tf/tfMessage has the same layout and another name and sum.
    std::vector<geometry_msgs::TransformStamped> transforms;
    if (instance.isType<tf2_msgs::TFMessage>()) {
      transforms = bag_->read<tf2_msgs::TFMessage>(instance)->transforms;
    } else if (instance.getDataType() == "tf/tfMessage") {
      std::vector<std::uint8_t> bytes(instance.size());
      ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      instance.write(out);
      ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      ros::serialization::deserialize(in, transforms);
    }
    for (geometry_msgs::TransformStamped& transform : transforms) bad_transforms_ += tf_.add(std::move(transform), fixed) ? 0 : 1;
  }

  // In order of stamps; of one stamp the first.
  template <class T>
  void sort_and_thin(std::vector<T>& values, const std::string& what) {
    std::size_t back = 0;
    for (std::size_t i = 1; i < values.size(); ++i) back += values[i].stamp < values[i - 1].stamp ? 1 : 0;
    sort_by_stamp(values);
    std::vector<T> kept;
    for (T& value : values) {
      if (kept.empty() || kept.back().stamp != value.stamp) kept.push_back(std::move(value));
    }
    const std::size_t twice = values.size() - kept.size();
    values = std::move(kept);
    if (back > 0) contents_.remarks.push_back(std::to_string(back) + " " + what + " came out of order and are sorted by their stamps");
    if (twice > 0) contents_.remarks.push_back(std::to_string(twice) + " " + what + " have a stamp that was there before and are left out");
  }

  void pair_pictures() {
    for (const auto& [c, d] : pairs_by_stamp(colours_, depths_, from_seconds(config_.association_s))) {
      const Picture& colour = colours_[c];
      const Picture& depth = depths_[d];
      RecordedFrame frame{colour.stamp, depth.stamp, stored(*colour.instance, true), stored(*depth.instance, false)};
      if (!natives_.empty()) {
        const Picture& native = natives_[nearest_stamp(natives_, depth.stamp)];
        if (std::abs(native.stamp - depth.stamp) <= from_seconds(config_.association_s))
          frame.native_depth = stored(*native.instance, false);
      }
      contents_.frames.push_back(std::move(frame));
    }
    if (!colours_.empty() && contents_.frames.empty()) {
      throw Error(bag_->file(), "has no colour picture with a depth image within " + std::to_string(config_.association_s) + " s (" +
                                    std::to_string(colours_.size()) + " in " + colour_topic_ + ", " + std::to_string(depths_.size()) +
                                    " in " + depth_topic_ + ")");
    }
    remark_unpaired(contents_, colours_.size(), depths_.size(), config_.association_s);
    if (bad_readings_ > 0) contents_.remarks.push_back(std::to_string(bad_readings_) + " odometry readings are no poses and are left out");
    if (bad_scans_ > 0) contents_.remarks.push_back(std::to_string(bad_scans_) + " scans name no angles and are left out");
    if (bad_transforms_ > 0) contents_.remarks.push_back(std::to_string(bad_transforms_) + " transforms are none and are left out");
  }

  StoredImage stored(const rosbag::MessageInstance& instance, bool colour) const {
    const std::string name =
        bag_->file().string() + ": " + instance.getTopic() + " at " + std::to_string(instance.getTime().toSec()) + " s";
    const bool raw = topics_.type(instance.getTopic()) == kImage;
    return {name, [bag = bag_, instance, colour, raw, name] {
              if (raw) {
                const auto message = bag->read<sensor_msgs::Image>(instance);
                return colour ? colour_of(*message, name) : depth_of(*message, name);
              }
              const auto message = bag->read<sensor_msgs::CompressedImage>(instance);
              return colour ? colour_of(*message, name) : depth_of(*message, name);
            }};
  }

  // Where a frame is on the vehicle; nothing where tf does not say.
  std::optional<Pose> on_vehicle(const std::string& frame) const { return tf_.last(config_.bag.base_frame, frame); }

  void mount_sensors() {
    if (!config_.bag.camera_frame.empty()) camera_frame_ = frame_name(config_.bag.camera_frame);
    if (!config_.bag.laser_frame.empty()) laser_frame_ = frame_name(config_.bag.laser_frame);
    const auto mount = [&](const std::string& frame, const std::vector<double>& given, const std::string& sensor) {
      const std::optional<Pose> found = on_vehicle(frame);
      if (!found && given.empty() && !has_calibration_beside()) {
        throw Error(bag_->file(), "tf does not say where the " + sensor + " (frame '" + frame + "') is on the vehicle (frame '" +
                                      config_.bag.base_frame + "'); expected recording." + sensor + "_mount, recording.bag." + sensor +
                                      "_frame, recording.bag.base_frame, or a recording.yaml beside the bag");
      }
      return found;
    };
    if (!contents_.frames.empty()) contents_.X_BC = mount(camera_frame_, config_.camera_mount, "camera");
    expect_registered_depth();
    see_native_depth();
    if (contents_.has_laser) contents_.X_BL = mount(laser_frame_, config_.laser_mount, "laser");
  }

  // Of the frames, where tf says how the camera stands in the world.
  void find_poses() {
    const std::string& world = config_.bag.world_frame;
    if (world.empty() || contents_.frames.empty()) return;
    const Stamp max_gap = from_seconds(config_.max_pose_gap_s);
    std::size_t unknown = 0, in_gaps = 0;
    for (RecordedFrame& frame : contents_.frames) {
      const Stamp stamp = frame.stamp + from_seconds(config_.clock.colour_s);  // as tf's clock has it
      const BagTransforms::Found found = tf_.at(world, camera_frame_, stamp, max_gap);
      frame.X_WC = found.X;
      if (!found.X) ++(found.in_gap ? in_gaps : unknown);
    }
    if (unknown + in_gaps == contents_.frames.size()) {
      throw Error(bag_->file(),
                  "tf says of no frame where the camera (frame '" + camera_frame_ + "') is in the world (frame '" + world +
                      "'); expected " +
                      (in_gaps > 0 ? "messages at most recording.max_pose_gap_s apart, " + std::to_string(config_.max_pose_gap_s) + " s"
                                   : "recording.bag.world_frame to be one that tf knows"));
    }
    remark_without_pose(contents_, unknown, in_gaps, "tf", config_.max_pose_gap_s);
  }

  // Depth of another view than the picture's would be mapped beside the objects.
  void expect_registered_depth() const {
    if (config_.bag.registered == "yes" || contents_.frames.empty()) return;
    const std::string expected = "; expected the topic of depth that is registered to the picture, or recording.bag.registered=yes";
    const std::optional<Pose> X_BD = on_vehicle(depth_frame_), X_BC = on_vehicle(camera_frame_);
    constexpr double kSame_m = 1e-4, kSame_rad = 1e-3;
    if (X_BD && X_BC) {
      const Pose X_CD = X_BC->inverse() * *X_BD;
      if (X_CD.translation().norm() > kSame_m || std::abs(Eigen::AngleAxisd(X_CD.linear()).angle()) > kSame_rad) {
        throw Error(bag_->file(), depth_topic_ + " is in frame '" + depth_frame_ +
                                      "', which is not where the picture's camera is (frame '" + camera_frame_ + "')" + expected);
      }
    }
    if (!depth_info_ || !first_info_) return;
    for (const std::size_t i : {0u, 2u, 4u, 5u}) {
      if (std::abs(depth_info_->K[i] - first_info_->K[i]) <= 0.01 * std::abs(first_info_->K[i]) + 0.5) continue;
      throw Error(bag_->file(), depth_topic_ + " is taken with another lens than " + colour_topic_ + " (camera_info's K: " +
                                    std::to_string(depth_info_->K[i]) + " and " + std::to_string(first_info_->K[i]) + ")" + expected);
    }
  }

  // The depth camera's own view, where its lens and its place are known; without them its images are of no use.
  void see_native_depth() {
    const std::optional<Pose> X_BD = on_vehicle(native_frame_), X_BC = on_vehicle(camera_frame_);
    const std::optional<Distortion> distortion = native_info_ ? distortion_of(*native_info_) : std::nullopt;
    if (X_BD && X_BC && distortion && native_info_->K[0] > 0.0 && native_info_->K[4] > 0.0) {
      const auto& k = native_info_->K;
      contents_.native = DepthCameraView{
          Lens(Intrinsics::checked(static_cast<int>(native_info_->width), static_cast<int>(native_info_->height), k[0], k[4], k[2], k[5]),
               *distortion),
          X_BC->inverse() * *X_BD};
    } else if (!has_calibration_beside()) {
      for (RecordedFrame& frame : contents_.frames) frame.native_depth = {};
    }
  }

  bool has_calibration_beside() const { return fs::exists(bag_->file().parent_path() / "recording.yaml"); }

  const RecordingConfig& config_;
  std::shared_ptr<OpenBag> bag_;
  rosbag::View view_;
  Topics topics_;
  std::string colour_topic_, depth_topic_, native_topic_, info_topic_, depth_info_topic_, native_info_topic_, laser_topic_, odometry_topic_;
  std::string camera_frame_, depth_frame_, native_frame_, laser_frame_;
  std::optional<sensor_msgs::CameraInfo> first_info_, depth_info_, native_info_;
  std::vector<Picture> colours_, depths_, natives_;
  BagTransforms tf_;
  std::size_t bad_readings_ = 0, bad_scans_ = 0, bad_transforms_ = 0;
  RecordingContents contents_;
};

}  // namespace

RecordingContents read_ros_bag(const fs::path& file, const RecordingConfig& config) {
  // What the libraries would print is said in errors and remarks.
  console_bridge::noOutputHandler();
  return BagReader(file, config).read();
}

}  // namespace waretwin
