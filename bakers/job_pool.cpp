// Lanes of one arena pull the next job; bakes inside enter arenas of their own, where idle threads join them.
#include "bakers/job_pool.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <vector>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace brickfield {

int threadsFor(int threads) {
  const int most = tbb::this_task_arena::max_concurrency();
  return threads > 0 ? std::min(threads, most) : most;
}

void runJobs(std::size_t count, int threads, const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> hasFailed{false};
  std::vector<std::exception_ptr> errors(count);
  const auto pullJobs = [&] {
    for (std::size_t i; !hasFailed && (i = next++) < count;) {
      try {
        job(i);
      } catch (...) {
        errors[i] = std::current_exception();
        hasFailed = true;
      }
    }
  };
  const int lanes = threadsFor(threads);
  tbb::task_arena arena(lanes);
  arena.execute([&] {
    tbb::parallel_for(
        0, lanes, [&](int) { pullJobs(); }, tbb::simple_partitioner());
  });
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

} // namespace brickfield
