// Threads of devices and loop: bounded joins, and crash handlers that run after a stack overflow.
#include "hal/thread.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>

namespace {

std::atomic<clockid_t> joined_by{-1};

}  // namespace

/// Replaces the C library's function, which it calls: tells by which clock a join was bounded.
extern "C" int pthread_clockjoin_np(pthread_t thread, void** value, clockid_t clock,
                                    const timespec* until) {
  joined_by = clock;
  using Join = int (*)(pthread_t, void**, clockid_t, const timespec*);
  static const auto real = reinterpret_cast<Join>(dlsym(RTLD_NEXT, "pthread_clockjoin_np"));
  return real(thread, value, clock, until);
}

namespace hal {
namespace {

using std::chrono::milliseconds;

TEST(Thread, IsWaitedForByAClockThatNobodySets) {
  std::atomic<bool> go_on{false};
  Thread thread;
  ASSERT_EQ(thread.start("hangs", {},
                         [&] {
                           while (!go_on) usleep(1000);
                         }),
            0);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(thread.join_for(milliseconds(30)));
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(30));
  EXPECT_EQ(joined_by, CLOCK_MONOTONIC) << "null would wait for a clock that was set back";
  go_on = true;
  EXPECT_TRUE(thread.join_for(milliseconds(10'000)));
}

[[gnu::noinline]] int overflow(int depth) {
  volatile char bytes[4096];
  std::memset(const_cast<char*>(bytes), depth, sizeof bytes);
  return depth < 0 ? 0
                   : overflow(depth + 1) + bytes[static_cast<std::size_t>(depth) % sizeof bytes];
}

TEST(ThreadDeathTest, AStackOverflowReachesTheHandlerThatCommandsNull) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer owns the signal stack";
#endif
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        struct sigaction action {};
        action.sa_handler = [](int) { _exit(7); };
        action.sa_flags = SA_ONSTACK;
        sigaction(SIGSEGV, &action, nullptr);
        Thread thread;
        (void)thread.start("deep", {}, [] { (void)overflow(0); });
        thread.join();
        _exit(1);
      },
      testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace hal
