// Sequences on disk: maps and truths that belong together, as `waretwin score --protocol scenenn` takes them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/score/scenenn_score.h"

namespace waretwin {

// `map` is a cuboids.json, a folder with one (a sequence named like the folder), or a folder of such folders; `truth` in the same way with
// truth.json or an annotation (truth_file.h), and may be the same folder. A timing.csv beside a cuboids.json comes along. Sequences are in
// the order of their names. Throws Error, naming the sequence, for a map without truth or a truth without map, where nothing is found,
// where map and truth of a sequence are in different frames, and for what cannot be read.
std::vector<MappedSequence> read_sequences(const std::filesystem::path& map, const std::filesystem::path& truth);

}  // namespace waretwin
