// Parallel loops whose result does not depend on how many threads run them.
#pragma once

#include <cstddef>
#include <functional>

namespace waretwin {

// Limits every parallel loop of the process (TBB's, and so Embree's) to `threads`; 0 gives back all cores. Throws Error below 0.
void set_thread_count(int threads);
int thread_count();

// Calls body(begin, end) for consecutive pieces of [0, count), each `grain` long but the last. The pieces are the same at any thread
// count, so a body may keep one partial result a piece (begin / grain) and the caller may add those up in order. An exception in a body
// is rethrown here; which one is unspecified when several pieces throw.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace waretwin
