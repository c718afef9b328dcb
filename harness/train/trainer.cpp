#include "harness/train/trainer.h"

#include <ATen/ATen.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <sstream>

#include "core/config.h"
#include "core/digest.h"
#include "core/error.h"
#include "core/files.h"
#include "core/version.h"
#include "harness/train/average_precision.h"
#include "harness/train/checkpoint.h"
#include "harness/train/darknet_weights.h"
#include "harness/train/epoch_loader.h"
#include "harness/train/network.h"
#include "harness/train/optimiser.h"
#include "harness/train/precision.h"
#include "harness/train/region_loss.h"
#include "harness/train/start_model.h"
#include "mapper/detect/resized_picture.h"

namespace waretwin::train {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kUsualPictures = 54000.0;  // shown in a training whose length nobody says: about 20 minutes on two cores
constexpr int kLeastEpochs = 12;
constexpr int kIouSteps = 10;       // of COCO's AP: 0.5, 0.55, ... 0.95
constexpr double kLateShare = 0.3;  // of the training, at its end: the best of these epochs is kept
constexpr std::size_t kStatisticsPictures = 240, kUnfoldPictures = 32;
constexpr float kLeastScore = 0.005f, kNmsIou = 0.45f;  // of validation
constexpr std::int64_t kMegabyte = 1'000'000;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

LabelledSet read_split(const fs::path& dataset, const std::string& split) {
  LabelledSet set = read_labelled_set(dataset, split);
  if (set.images.empty()) throw Error(dataset, "split '" + split + "' has no pictures; expected some to train a detector");
  const bool labelled = std::any_of(set.images.begin(), set.images.end(), [](const LabelledImage& image) {
    return std::any_of(image.boxes.begin(), image.boxes.end(), [](const LabelledBox& box) { return !box.ignored; });
  });
  if (!labelled)
    throw Error(dataset, "split '" + split + "' has " + std::to_string(set.images.size()) + " pictures and no box; expected labels");
  return set;
}

std::vector<BoxShape> shapes_in_cells(const LabelledSet& set, const TrainConfig& config) {
  std::vector<BoxShape> shapes;
  for (const LabelledImage& image : set.images) {
    for (const LabelledBox& box : image.boxes) {
      if (box.ignored) continue;
      shapes.push_back({box.share.width * config.width / NetworkPlan::kCell, box.share.height * config.height / NetworkPlan::kCell});
    }
  }
  return shapes;
}

std::string config_text(TrainConfig config) {
  return write_config([&](Fields& f) { f.group("train", config, "training of a detector"); });
}

std::optional<StartModel> model_to_start_from(const TrainingRequest& request) {
  if (request.start.empty()) return std::nullopt;
  StartModel start = read_start_model(request.start);
  if (fs::exists(request.out) && fs::equivalent(start.folder, request.out))
    throw Error(request.out, "holds the detector to start from; expected another --out");
  return start;
}

// With what is left to the machine decided, so that train.yaml and the checkpoint say it.
TrainConfig decided(TrainConfig config, const std::optional<StartModel>& start) {
  config.precision = decided_precision(config.precision);
  if (start) config.anchors = static_cast<int>(start->network.plan().anchors.size());
  return config;
}

// What must be the same for a training to go on: all but how long it takes.
std::string lasting_text(const std::string& name, const TrainConfig& config, const LabelledSet& set, const LabelledSet& valid,
                         const std::optional<StartModel>& start) {
  TrainConfig lasting = config;
  lasting.epochs = lasting.patience = 0;
  lasting.minutes = lasting.cache_mb = 0.0;
  std::string text = "name: " + name + "\n" + config_text(lasting) + "pictures: " + std::to_string(set.images.size()) + "\nclasses:";
  for (const std::string& class_name : set.classes) text += " " + class_name;
  // Boxes make the anchors, which the weights are learned for.
  Digest boxes;
  for (const LabelledSet* part : {&set, &valid}) {
    for (const LabelledImage& image : part->images) {
      boxes.add(image.name);
      for (const LabelledBox& box : image.boxes) {
        boxes.add(box.class_index);
        boxes.add(static_cast<int>(box.ignored));
        for (const double value : {box.share.x, box.share.y, box.share.width, box.share.height}) boxes.add(value);
      }
    }
  }
  text += "\nlabels: " + boxes.hex() + "\nfrom: ";
  if (!start) return text + "drawn weights\n";
  return text + start->digest + "\n";
}

void check_same(const fs::path& file, const std::string& before, const std::string& now) {
  std::istringstream old_lines(before), new_lines(now);
  for (std::string old_line, new_line; std::getline(old_lines, old_line);) {
    std::getline(new_lines, new_line);
    if (old_line == new_line) continue;
    const auto plain = [](const std::string& line) {
      return line.substr(std::min(line.size(), line.find_first_not_of(' '))).substr(0, 80);
    };
    const auto key = [](const std::string& line) { return line.substr(0, line.find(':')); };
    if (key(old_line) != key(new_line)) throw Error(file, "was begun by another version of waretwin; expected the same to --resume");
    throw Error(file, "was begun with '" + plain(old_line) + "', now it is '" + plain(new_line) + "'; expected the same to --resume");
  }
}

void remove_file(const fs::path& file) {
  std::error_code problem;
  fs::remove(file, problem);
  if (problem) throw Error(file, "cannot be replaced: " + problem.message());
}

at::Tensor as_tensor(const std::vector<Sample>& batch) {
  const cv::Size size = batch.front().picture.size();
  // Row, column, channel: what libtorch calls channels last.
  at::Tensor bytes = at::empty({static_cast<std::int64_t>(batch.size()), size.height, size.width, 3}, at::kByte);
  const std::size_t each = 3 * static_cast<std::size_t>(size.area());
  for (std::size_t i = 0; i < batch.size(); ++i) std::memcpy(bytes.data_ptr<std::uint8_t>() + i * each, batch[i].picture.data, each);
  return bytes.permute({0, 3, 1, 2}).to(at::kFloat).div_(255.0);
}

class Training {
 public:
  Training(const TrainingRequest& request, const TrainingHooks& hooks)
      : request_(request),
        hooks_(hooks),
        start_(model_to_start_from(request)),
        config_(decided(request.config, start_)),
        type_(type_of(config_.precision)),
        train_(read_split(request.dataset, "train")),
        valid_(read_split(request.dataset, "valid")),
        plan_(make_plan()),
        network_(plan_, config_.seed),
        average_(plan_, config_.seed),
        optimiser_(network_.learned(), config_.weight_decay),
        valid_pictures_(valid_, {config_.width, config_.height}, cache_bytes() / 2),
        train_pictures_(train_, cached_size(),
                        cache_bytes() - std::min(cache_bytes() / 2, bytes_of(valid_, {config_.width, config_.height}))) {
    steps_per_epoch_ = static_cast<int>(epoch_order(train_.images.size(), config_, 0).size()) / config_.batch;
    if (train_.classes != valid_.classes) throw Error(request.dataset, "splits train and valid name different classes");
    if (config_.epochs == 0 && config_.minutes == 0.0) {
      config_.epochs = std::max(kLeastEpochs, static_cast<int>(std::ceil(kUsualPictures / (steps_per_epoch_ * config_.batch))));
    }
  }

  TrainingSummary run() {
    make_folder(request_.out);
    expect_no_other_model();
    load();
    write_file(request_.out / "train.yaml", "# waretwin " + std::string(kVersion) + ", dataset " + request_.dataset.string() +
                                                (start_ ? ", from " + start_->given : "") + "\n" + config_text(config_));
    announce();
    while (!finished()) {
      run_epoch();
      write_file(request_.out / "log.csv", state_.log);
      save();
    }
    return write_model();
  }

 private:
  NetworkPlan make_plan() const {
    const std::vector<BoxShape> shapes = shapes_in_cells(train_, config_);
    return plan_network(config_.width, config_.height, static_cast<int>(train_.classes.size()),
                        start_ ? start_->network.plan().anchors : find_anchors(shapes, config_.anchors));
  }

  std::int64_t cache_bytes() const { return static_cast<std::int64_t>(config_.cache_mb) * kMegabyte; }
  cv::Size cached_size() const {
    return {static_cast<int>(std::lround(config_.cache_scale * config_.width)),
            static_cast<int>(std::lround(config_.cache_scale * config_.height))};
  }
  static std::int64_t bytes_of(const LabelledSet& set, const cv::Size& size) {
    return 3 * static_cast<std::int64_t>(set.images.size()) * size.area();
  }

  fs::path checkpoint_file() const { return request_.out / "checkpoint"; }
  fs::path model_file(const char* ending) const { return request_.out / (request_.name + ending); }

  // Whoever takes a model by its folder expects one.
  void expect_no_other_model() const {
    std::error_code problem;
    for (const fs::directory_entry& entry : fs::directory_iterator(request_.out, problem)) {
      const std::string name = entry.path().stem().string(), ending = entry.path().extension().string();
      const bool is_model = ending == ".cfg" || ending == ".weights" || ending == ".onnx";
      if (!is_model || name.starts_with('.') || name == request_.name) continue;  // a dot: what a kill left half-written
      throw Error(request_.out, "holds the model '" + name + "'; expected another --out, or --name " + name + " to replace it");
    }
    if (problem) throw Error(request_.out, "cannot be read: " + problem.message());
  }

  // How much of the training is over: the schedule of learning rate and augmentation. By time only where a limit is set.
  double share_done(double step) const {
    double share = config_.epochs > 0 ? step / (static_cast<double>(config_.epochs) * steps_per_epoch_) : 0.0;
    if (config_.minutes > 0.0) {
      // The time that validation takes is kept for it.
      const double seconds = state_.seconds + state_.validation_seconds + (training_ ? seconds_since(epoch_start_) : 0.0);
      share = std::max(share, seconds / (60.0 * config_.minutes));
    }
    return std::min(share, 1.0);
  }

  bool finished() const {
    const bool patient = config_.patience == 0 || state_.epochs_done - state_.patience_from < config_.patience;
    return state_.epochs_done > 0 && (share_done(static_cast<double>(state_.steps)) >= 1.0 || !patient);
  }

  double rate_at(double share) const {
    const double cosine = config_.final_rate + (1.0 - config_.final_rate) * 0.5 * (1.0 + std::cos(M_PI * share));
    return config_.learning_rate * cosine * std::min(1.0, static_cast<double>(state_.steps + 1) / (config_.warm_up + 1));
  }

  void load() {
    state_.config = lasting_text(request_.name, config_, train_, valid_, start_);
    state_.log = "epoch,box_loss,object_loss,class_loss,ap,ap50,ap75,side_error_px,learning_rate,seconds\n";
    for (const std::vector<at::Tensor>& tensors :
         {network_.learned(), network_.followed(), average_.learned(), average_.followed(), optimiser_.state()}) {
      state_.tensors.insert(state_.tensors.end(), tensors.begin(), tensors.end());
    }
    if (!request_.resume || !fs::exists(checkpoint_file())) {
      if (request_.resume && fs::exists(model_file(".weights")) && fs::exists(model_file(".cfg")))
        throw Error(checkpoint_file(), "not there, but a finished detector is; expected no --resume, which replaces it, or another --out");
      remove_earlier();
      if (start_) begin_with_start();
      return;
    }
    check_same(checkpoint_file(), checkpoint_config(checkpoint_file()), state_.config);
    read_checkpoint(checkpoint_file(), state_);
    optimiser_.steps = state_.steps;
    if (state_.best_is_late != 0 && share_done(static_cast<double>(state_.steps)) < 1.0 - kLateShare) {
      // Longer than it was meant to be: its own late epochs decide, and patience is for those that come.
      state_.best_is_late = 0;
      state_.patience_from = state_.epochs_done;
    }
  }

  void begin_with_start() {
    start_from(*start_, train_.classes, network_);
    network_.unfold_statistics(spread_pictures(0, kUnfoldPictures, kUnfoldPictures));
    follow_average(average_, network_, 0.0);
  }

  // No old model stands beside a new train.yaml. What is in a folder without one is not ours.
  void remove_earlier() const {
    if (!fs::exists(request_.out / "train.yaml")) return;
    for (const fs::path& file :
         {checkpoint_file(), request_.out / "log.csv", model_file(".weights"), model_file(".cfg"), model_file(".names")}) {
      remove_file(file);
    }
  }

  void save() { write_checkpoint(checkpoint_file(), state_); }

  void announce() const {
    if (!hooks_.started) return;
    TrainingSet set;
    set.train_pictures = train_.images.size();
    set.valid_pictures = valid_.images.size();
    set.classes = train_.classes.size();
    const std::vector<BoxShape> shapes = shapes_in_cells(train_, config_);
    set.boxes = shapes.size();
    set.cache_mb =
        static_cast<double>(std::min(cache_bytes(), bytes_of(train_, cached_size()) + bytes_of(valid_, {config_.width, config_.height}))) /
        kMegabyte;
    set.anchor_iou = mean_best_iou(shapes, plan_.anchors);
    set.parameters = parameter_count(plan_);
    if (start_) {
      set.known_classes = static_cast<int>(std::count_if(train_.classes.begin(), train_.classes.end(), [&](const std::string& name) {
        return std::find(start_->classes.begin(), start_->classes.end(), name) != start_->classes.end();
      }));
    }
    set.epochs_done = static_cast<int>(state_.epochs_done);
    hooks_.started(set);
  }

  void run_epoch() {
    epoch_start_ = Clock::now();
    training_ = true;
    EpochResult result;
    result.epoch = static_cast<int>(state_.epochs_done) + 1;
    const int steps = train_once(result);
    for (double* const loss : {&result.box_loss, &result.object_loss, &result.class_loss}) *loss /= steps;
    renew_statistics();
    validate(result);
    training_ = false;
    result.seconds = seconds_since(epoch_start_);
    state_.seconds += result.seconds;
    ++state_.epochs_done;
    keep_if_best(result);
    char line[256];
    std::snprintf(line, sizeof line, "%d,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.2f,%.3g,%.2f\n", result.epoch, result.box_loss, result.object_loss,
                  result.class_loss, result.ap, result.ap50, result.ap75, result.side_error_px, result.rate, result.seconds);
    state_.log += line;
    if (hooks_.epoch) hooks_.epoch(result);
  }

  // Once through the pictures; how many steps that took.
  int train_once(EpochResult& result) {
    const double begun = share_done(static_cast<double>(state_.steps));
    EpochStyle style{{config_.width, config_.height}, begun >= 1.0 - config_.augment.plain_share};
    // What is learned of small pictures holds for large ones, where an object looks like a nearer one; anchors keep their cells.
    if (begun < config_.small_share) style.size = config_.small_size();
    NetworkPlan plan = plan_;
    plan.width = style.size.width;
    plan.height = style.size.height;
    EpochLoader loader(train_pictures_, config_, static_cast<int>(state_.epochs_done), style);
    int steps = 0;
    while (const auto batch = loader.next()) {
      if (hooks_.check) hooks_.check();
      const double share = share_done(static_cast<double>(state_.steps));
      if (share >= 1.0 && steps > 0) break;
      result.rate = rate_at(share);
      step(*batch, plan, result);
      ++steps;
      report(result.epoch, steps, share);
    }
    return steps;
  }

  // Means and variances that belong to the averaged weights, from pictures as a detector sees them.
  void renew_statistics() {
    const auto batch_size = static_cast<std::size_t>(config_.batch);
    const std::size_t shown = std::min(train_pictures_.count(), kStatisticsPictures);
    int index = 0;
    for (std::size_t first = 0; first < shown; first += batch_size) {
      if (hooks_.check) hooks_.check();
      average_.renew_statistics(spread_pictures(first, batch_size, shown), index++);
    }
  }

  // Up to `count` of `shown` training pictures, which lie evenly spread over the set, as a detector sees them.
  at::Tensor spread_pictures(std::size_t first, std::size_t count, std::size_t shown) {
    std::vector<Sample> batch;
    const std::size_t all = train_pictures_.count();
    shown = std::min(shown, all);
    for (std::size_t i = first; i < std::min(shown, first + count); ++i) {
      Sample& sample = batch.emplace_back();
      sample.picture.create(config_.height, config_.width, CV_8UC3);
      resize_picture(train_pictures_.get(i * all / shown).picture, sample.picture);
    }
    return as_tensor(batch);
  }

  // `plan`: with the size of the batch's pictures.
  void step(const std::vector<Sample>& batch, const NetworkPlan& plan, EpochResult& result) {
    std::vector<std::vector<TruthBox>> truth;
    for (const Sample& sample : batch) truth.push_back(sample.boxes);
    const RegionLoss loss = region_loss(network_.learn(as_tensor(batch), type_), truth, plan, config_);
    if (!std::isfinite(loss.total.item<double>())) {
      throw Error("the loss is no number after " + std::to_string(state_.steps) + " steps; expected a smaller train.learning_rate");
    }
    loss.total.backward();
    optimiser_.step(result.rate, config_.largest_gradient);
    ++state_.steps;
    // The first weights are soon forgotten.
    const auto t = static_cast<double>(state_.steps);
    follow_average(average_, network_, std::min(config_.average_decay, (1.0 + t) / (10.0 + t)));
    result.box_loss += loss.box;
    result.object_loss += loss.object;
    result.class_loss += loss.classes;
  }

  void report(int epoch, int steps, double share) const {
    if (!hooks_.progress) return;
    const double seconds = seconds_since(epoch_start_);
    const double overall = state_.seconds + seconds;
    double left = share > 0.0 ? overall * (1.0 - share) / share : 0.0;
    if (config_.minutes > 0.0) left = std::min(left, std::max(0.0, 60.0 * config_.minutes - overall));
    hooks_.progress({share, epoch, steps * config_.batch / std::max(seconds, 1e-9), left});
  }

  void validate(EpochResult& result) {
    const auto start = Clock::now();
    const at::NoGradGuard no_gradients;
    std::vector<std::vector<ScoredBox>> found;
    std::vector<std::vector<TruthBox>> truth;
    const std::size_t count = valid_pictures_.count();
    for (std::size_t first = 0; first < count; first += static_cast<std::size_t>(config_.batch)) {
      if (hooks_.check) hooks_.check();
      std::vector<Sample> batch;
      for (std::size_t i = first; i < std::min(count, first + static_cast<std::size_t>(config_.batch)); ++i)
        batch.push_back(valid_pictures_.get(i));
      const at::Tensor output = average_.detect(as_tensor(batch)).contiguous(at::MemoryFormat::Contiguous);
      for (std::size_t i = 0; i < batch.size(); ++i) {
        found.push_back(region_boxes(output[static_cast<std::int64_t>(i)].data_ptr<float>(), plan_, kLeastScore, kNmsIou));
        truth.push_back(batch[i].boxes);
      }
    }
    const int classes = plan_.classes;
    for (int step = 0; step < kIouSteps; ++step) {
      const double ap = average_precision(found, truth, classes, 0.5f + 0.05f * static_cast<float>(step));
      result.ap += ap / kIouSteps;
      if (step == 0) result.ap50 = ap;
      if (step == kIouSteps / 2) result.ap75 = ap;
    }
    balanced_score_ = balanced_score(found, truth, classes, 0.5f);
    // Pictures are taken for 16:9, as those of the camera that the figure is about.
    result.side_error_px = median_side_error(found, truth, 1280, 720);
    state_.validation_seconds = seconds_since(start);
  }

  // By the AP over all IoU, and among the late epochs: with few pictures to validate on, AP50 jumps up and down by a tenth, and the best of
  // many such numbers says little.
  void keep_if_best(EpochResult& result) {
    const bool late = share_done(static_cast<double>(state_.steps)) >= 1.0 - kLateShare, first_late = late && state_.best_is_late == 0;
    if (state_.best_epoch >= 0 && !first_late && result.ap <= state_.best_fitness) return;
    result.best = true;
    state_.best_is_late = late ? 1 : 0;
    state_.best_fitness = result.ap;
    state_.best_ap50 = result.ap50;
    state_.best_epoch = state_.patience_from = state_.epochs_done;
    // A detector keeps what scores 0.5 unless told otherwise.
    state_.best_weights = darknet_weights(average_, state_.steps * config_.batch, -std::log(balanced_score_ / (1.0 - balanced_score_)));
  }

  TrainingSummary write_model() const {
    // Old weights never stand beside a new description.
    remove_file(model_file(".weights"));
    std::string names;
    for (const std::string& name : train_.classes) names += name + "\n";
    write_file(model_file(".cfg"), darknet_cfg(plan_));
    write_file(model_file(".names"), names);
    write_file(model_file(".weights"), state_.best_weights);
    return {static_cast<int>(state_.epochs_done), static_cast<int>(state_.best_epoch), state_.best_ap50, state_.seconds,
            model_file(".weights")};
  }

  const TrainingRequest& request_;
  const TrainingHooks& hooks_;
  std::optional<StartModel> start_;
  TrainConfig config_;
  at::ScalarType type_;  // of what lies between the layers while learning
  LabelledSet train_, valid_;
  NetworkPlan plan_;
  Network network_, average_;
  Optimiser optimiser_;
  PictureCache valid_pictures_, train_pictures_;
  Checkpoint state_;
  int steps_per_epoch_ = 1;
  Clock::time_point epoch_start_;
  bool training_ = false;
  double balanced_score_ = 0.5;  // of the last validation
};

}  // namespace

TrainingSummary train_detector(const TrainingRequest& request, const TrainingHooks& hooks) {
  // OpenCV's own threads would stand in libtorch's way.
  cv::setNumThreads(1);
  return Training(request, hooks).run();
}

}  // namespace waretwin::train
