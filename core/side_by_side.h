// Whole jobs side by side, each on one thread: less waiting than one job after the other on all of them, where there are many.
#pragma once

#include <cstddef>
#include <functional>

namespace waretwin {

// Calls work(0) ... work(workers - 1), each on a thread of its own whose parallel loops (core/parallel.h) use no other one. Returns when
// all have; of what they throw the first is rethrown then, so they should look for a stop themselves.
void run_side_by_side(std::size_t workers, const std::function<void(std::size_t worker)>& work);

// How many jobs of so many bytes each fit into the memory that is free now; at least 1.
std::size_t jobs_in_memory(double bytes);

}  // namespace waretwin
