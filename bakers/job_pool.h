// Threads of bakes, several at once: each still spreads over all threads that the others leave idle.
#pragma once

#include <cstddef>
#include <functional>

namespace brickfield {

/// As many threads as asked for, but no more than there are: TBB would warn on the console.
///
/// threads    0: all
/// proved by  tests/bake/bakers/job_pool_test.cpp, by runJobs
int threadsFor(int threads);

/// Calls job(0) to job(count - 1), begun in this order, on as many threads; returns when all have ended.
///
/// threads   0: all; 1: one after another
/// error     the first job's that failed, by number; those that had not begun then are left out
/// proved by tests/bake/bakers/job_pool_test.cpp
void runJobs(std::size_t count, int threads, const std::function<void(std::size_t)>& job);

} // namespace brickfield
