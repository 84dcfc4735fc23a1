// Every job once, errors by number, several at a time.
#include "bakers/job_pool.h"

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace brickfield {
namespace {

TEST(JobPool, RunsEveryJobOnce) {
  for (const int threads : {0, 1, 2, 1000}) {
    std::vector<std::atomic<int>> calls(100);
    runJobs(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
    for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
  }
  runJobs(0, 0, [](std::size_t) { FAIL(); });
}

TEST(JobPool, OneThreadKeepsTheOrder) {
  std::vector<std::size_t> order;
  runJobs(20, 1, [&](std::size_t i) { order.push_back(i); });
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(order.at(i), i);
}

TEST(JobPool, TwoThreadsWorkAtOnce) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  std::atomic<int> running{0}, most{0};
  // Each waits for the other, however late a busy machine lets it begin.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  runJobs(8, 2, [&](std::size_t) {
    const int now = ++running;
    int before = most;
    while (now > before && !most.compare_exchange_weak(before, now)) {
    }
    while (most < 2 && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    --running;
  });
  EXPECT_EQ(most, 2);
}

TEST(JobPool, ThrowsTheFirstErrorAndBeginsNoMore) {
  for (const int threads : {1, 0}) {
    std::atomic<int> begun{0};
    try {
      runJobs(1000, threads, [&](std::size_t i) {
        ++begun;
        if (i == 3) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (i >= 3) throw std::runtime_error(std::to_string(i));
      });
      FAIL();
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "3");
    }
    EXPECT_LT(begun, 100);
  }
}

} // namespace
} // namespace brickfield
