#include "harness/train/train_options.h"

#include <CLI/CLI.hpp>
#include <charconv>

namespace waretwin {

void TrainOptions::add_to(CLI::App& command) {
  command
      .add_option("DATASET", dataset,
                  "labelled pictures with splits train and valid: a folder with a .data file (Darknet) or COCO JSON files")
      ->required();
  command.add_option("--out", out, "folder for the detector; an earlier training in it is replaced, unless with --resume")
      ->required()
      ->type_name("DIR");
  command.add_option("--name", name, "of the files: NAME.cfg, NAME.weights, NAME.names")->capture_default_str()->type_name("NAME");
  command
      .add_option("--from", from,
                  "starts from this detector, which `train` made (a folder or a shipped model: conveyor), instead of from nothing; "
                  "classes are matched by name, and the input may have another size")
      ->type_name("MODEL");
  command.add_flag("--resume", resume, "goes on from the checkpoint in DIR, if there is one");
  command.add_option("--epochs", epochs, "an epoch shows every picture, few of them several times (default: 54,000 pictures in all)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
  command.add_option("--minutes", minutes, "trains so long, validation included")->type_name("M")->check(number_from_to(0.01, 1e6));
  common.add_to(command);
  command.get_option("--seed")->description("of first weights, order and augmentation (default 1)");
  command.get_option("--threads")->description("limits the threads; the same number gives the same weights (0: all cores)");
  command.footer(
      "Example:\n  waretwin train out/dataset --out out/detector --minutes 20\n"
      "  waretwin map RECORDING --out out/map --detector out/detector\n"
      "  waretwin train my/photographs --out out/mine --from conveyor --minutes 10 --set train.learning_rate=0.001\n\n"
      "--set takes the keys of train.yaml, e.g. train.batch=16, train.augment.mosaic=0. docs/training.md explains all.");
}

std::vector<std::string> TrainOptions::arguments() const {
  std::vector<std::string> words = {"--out", out, "--name", name};
  const auto add = [&](const char* option, const std::string& value) { words.insert(words.end(), {option, value}); };
  if (!from.empty()) add("--from", from);
  if (resume) words.emplace_back("--resume");
  if (epochs) add("--epochs", std::to_string(*epochs));
  if (minutes) {
    char text[64];
    add("--minutes", std::string(text, std::to_chars(text, text + sizeof text, *minutes).ptr));
  }
  if (common.seed) add("--seed", std::to_string(*common.seed));
  if (common.threads > 0) add("--threads", std::to_string(common.threads));
  for (const std::string& setting : common.set) add("--set", setting);
  if (common.quiet) words.emplace_back("--quiet");
  words.insert(words.end(), {"--", dataset});
  return words;
}

}  // namespace waretwin
