#include "harness/train/train_config.h"

#include <algorithm>
#include <cmath>

namespace waretwin::train {

void AugmentConfig::visit(Fields& f) {
  f("flip", flip, "chance that a picture is mirrored", {.min = 0, .max = 1});
  f("zoom_least", zoom_least, "smallest size of what is seen, 1 = as it is", {.min = 0.1, .max = 1});
  f("zoom_most", zoom_most, "largest size of what is seen", {.min = 1, .max = 10});
  f("aspect", aspect, "share by which width may change against height", {.min = 0, .max = 0.9});
  f("mosaic", mosaic, "chance that four pictures are laid into one", {.min = 0, .max = 1});
  f("plain_share", plain_share, "share of the training, at its end, without mosaics, when half of the pictures are shown whole",
    {.min = 0, .max = 1});
  f("hue_deg", hue_deg, "colours turn by up to this much", {.min = 0, .max = 180});
  f("saturation", saturation, "saturation changes by a factor of up to 1 + this", {.min = 0, .max = 5});
  f("exposure", exposure, "brightness changes by a factor of up to 1 + this", {.min = 0, .max = 5});
  f("blur", blur, "chance of a slight blur", {.min = 0, .max = 1});
  f("noise", noise, "chance of pixel noise", {.min = 0, .max = 1});
  f("noise_sigma", noise_sigma, "largest standard deviation of that noise, of 255", {.min = 0, .max = 100});
  f("cut_out", cut_out, "chance that one to three rectangles are painted over", {.min = 0, .max = 1});
  f("kept_share", kept_share, "a box of which less is left by crop and cut-out counts as ignored", {.min = 0, .max = 1});
}

cv::Size TrainConfig::small_size() const {
  const auto side = [this](int full) { return std::max(32, 32 * static_cast<int>(std::lround(small_scale * full / 32.0))); };
  return {side(width), side(height)};
}

void TrainConfig::visit(Fields& f) {
  f("width", width, "width of the network's input in pixels, a multiple of 32", {.min = 64, .max = 4096});
  f("height", height, "height of the network's input in pixels, a multiple of 32", {.min = 64, .max = 4096});
  if (width % 32 != 0) f.reject("width", std::to_string(width) + "; expected a multiple of 32");
  if (height % 32 != 0) f.reject("height", std::to_string(height) + "; expected a multiple of 32");
  f("anchors", anchors, "box shapes that each cell starts from, found in the data", {.min = 1, .max = 20});
  f("epochs", epochs, "how many; 0 = as many as make 54,000 pictures, at least 12", {.min = 0, .max = 1000000});
  f("minutes", minutes, "longest training, earlier runs of a resumed one included; 0 = no limit", {.min = 0, .max = 1e6});
  f("epoch_pictures", epoch_pictures, "a smaller set is repeated within an epoch until so many are shown", {.min = 1, .max = 1000000});
  f("patience", patience, "epochs without a better validation after which training ends; 0 = never", {.min = 0, .max = 1000000});
  f("seed", seed, "of first weights, order and augmentation");
  f("batch", batch, "pictures a step", {.min = 1, .max = 1024});
  f("learning_rate", learning_rate, "of AdamW after the warm-up", {.min = 0, .max = 1});
  f("final_rate", final_rate, "share of it that is left at the end, down a cosine", {.min = 0, .max = 1});
  f("warm_up", warm_up, "steps in which the learning rate grows from 0", {.min = 0, .max = 1000000});
  f("small_share", small_share, "share of the training, at its start, with smaller pictures, which take less time", {.min = 0, .max = 1});
  f("small_scale", small_scale, "size of these against the input", {.min = 0.1, .max = 1});
  f("precision", precision, "of what lies between the layers; auto = bfloat16 where the processor multiplies it faster",
    {.choices = {"auto", "float32", "bfloat16"}});
  f("weight_decay", weight_decay, "of convolution weights, as AdamW has it", {.min = 0, .max = 10});
  f("average_decay", average_decay, "of the moving average of weights that is validated and written", {.min = 0, .max = 0.99999});
  f("largest_gradient", largest_gradient, "norm to which gradients are cut", {.min = 1e-6, .max = 1e9});
  f("box_weight", box_weight, "weight of the boxes' loss (complete IoU)", {.min = 0, .max = 1000});
  f("object_weight", object_weight, "weight of the objectness' loss", {.min = 0, .max = 1000});
  f("class_weight", class_weight, "weight of the classes' loss", {.min = 0, .max = 1000});
  f("anchor_iou", anchor_iou, "anchors whose shape agrees so well with an object learn it, the best one always", {.min = 0, .max = 1});
  f("ignore_iou", ignore_iou, "a prediction elsewhere that overlaps an object by more is no mistake", {.min = 0, .max = 1});
  f("cache_mb", cache_mb, "memory for decoded pictures; those beyond it are decoded again each time", {.min = 0, .max = 1e6});
  f("cache_scale", cache_scale, "size of cached pictures against the network's input", {.min = 1, .max = 4});
  f.group("augment", augment, "how pictures are changed before they are shown");
}

}  // namespace waretwin::train
