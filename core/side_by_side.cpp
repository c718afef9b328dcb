#include "core/side_by_side.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <fstream>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace waretwin {

void run_side_by_side(std::size_t workers, const std::function<void(std::size_t)>& work) {
  std::exception_ptr failure;
  std::mutex mutex;
  std::vector<std::thread> threads;
  for (std::size_t worker = 0; worker < workers; ++worker) {
    threads.emplace_back([&, worker] {
      try {
        tbb::task_arena(1).execute([&] { work(worker); });
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}

std::size_t jobs_in_memory(double bytes) {
  std::ifstream memory("/proc/meminfo");
  std::string key, unit;
  double kilobytes = 0.0;
  while (memory >> key >> kilobytes) {
    std::getline(memory, unit);
    if (key == "MemAvailable:") return static_cast<std::size_t>(std::max(1.0, 1024.0 * kilobytes / bytes));
  }
  return 1;
}

}  // namespace waretwin
