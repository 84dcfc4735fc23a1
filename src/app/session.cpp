// Messages through spdlog and the handlers of SIGINT and SIGTERM.
#include "app/session.h"

#include <csignal>
#include <memory>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "core/error.h"

namespace brickfield {

namespace {

std::atomic<bool> interrupted{false};
std::atomic<int> interruptingSignal{SIGINT};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free,
              "a signal handler may only touch lock-free atomics");

void onSignal(int signal) {
  interruptingSignal.store(signal, std::memory_order_relaxed);
  interrupted.store(true, std::memory_order_relaxed);
}

spdlog::logger& logger() {
  static const std::shared_ptr<spdlog::logger> instance = [] {
    auto made = std::make_shared<spdlog::logger>("brickfield", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    made->set_pattern("brickfield: %v");
    return made;
  }();
  return *instance;
}

} // namespace

const std::atomic<bool>& isInterrupted() { return interrupted; }

void catchInterrupts() {
  struct sigaction action {};
  action.sa_handler = onSignal;
  action.sa_flags = SA_RESETHAND;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int interruptedExitCode() { return 128 + interruptingSignal.load(std::memory_order_relaxed); }

void printError(std::string_view text) { logger().error("{}", text); }

void printWarning(std::string_view text) { logger().warn("warning: {}", text); }

void printWarnings(const Scene& scene) {
  for (const std::string& warning : scene.warnings) printWarning(warning);
}

void throwIfInterrupted() {
  if (interrupted.load(std::memory_order_relaxed)) throw Cancelled();
}

} // namespace brickfield
