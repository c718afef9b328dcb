#include "core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <string>
#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

#include "core/error.h"

namespace waretwin {

namespace {

std::unique_ptr<tbb::global_control>& limit() {
  static std::unique_ptr<tbb::global_control> control;
  return control;
}

#ifdef __SANITIZE_THREAD__
// TBB's library is not built for ThreadSanitizer, which then takes its hand-overs between threads for races. Under it, plain threads run
// the pieces, so that what it reports are races of our own loops.
void run_pieces(std::size_t pieces, const std::function<void(std::size_t)>& run) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    for (std::size_t piece = next++; piece < pieces; piece = next++) {
      try {
        run(piece);
      } catch (...) {
        const std::lock_guard lock(failure_mutex);
        failure = std::current_exception();
        next = pieces;
      }
    }
  };
  std::vector<std::thread> helpers;
  for (int i = 1; i < std::min(thread_count(), 4); ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}
#else
void run_pieces(std::size_t pieces, const std::function<void(std::size_t)>& run) { tbb::parallel_for(std::size_t{0}, pieces, run); }
#endif

}  // namespace

void set_thread_count(int threads) {
  if (threads < 0) throw Error("threads: " + std::to_string(threads) + " is not a number of threads; expected 0 (all cores) or more");
  limit().reset();
  if (threads > 0) {
    limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
}

int thread_count() {
  const auto allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return static_cast<int>(allowed);
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  WARETWIN_CHECK(grain > 0, "a loop needs pieces of at least one element");
  const std::size_t pieces = (count + grain - 1) / grain;
  run_pieces(pieces, [&](std::size_t piece) {
    const std::size_t begin = piece * grain;
    body(begin, std::min(count, begin + grain));
  });
}

}  // namespace waretwin
