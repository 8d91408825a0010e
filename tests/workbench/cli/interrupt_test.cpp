// Signals while something long runs, each time in a process of its own.
#include "workbench/cli/interrupt.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace workbench::cli {
namespace {

constexpr int kAsked = 7;

/// Ends with kAsked when all signals were an order to stop.
[[noreturn]] void end() { _exit(Interrupt::exit_code() == 128 + SIGTERM ? kAsked : 1); }

// `timeout` signals the program and then its process group.
TEST(Interrupt, SignalsThatComeTogetherAreOneOrder) {
  const auto run = [] {
    const Interrupt interrupt;
    std::raise(SIGTERM);
    std::raise(SIGTERM);
    end();
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(kAsked), "");
}

TEST(Interrupt, ALaterSignalEndsTheProgram) {
  const auto run = [] {
    const Interrupt interrupt;
    std::raise(SIGTERM);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    std::raise(SIGTERM);
    end();
  };
  EXPECT_EXIT(run(), testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace workbench::cli
