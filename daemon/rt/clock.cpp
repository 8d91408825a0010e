#include "daemon/rt/clock.h"

#include <cerrno>
#include <ctime>

namespace monitor::rt {
namespace {

constexpr std::int64_t kNsPerS = 1'000'000'000;

std::int64_t read_ns(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * kNsPerS + t.tv_nsec;
}

}  // namespace

std::int64_t MonotonicClock::now_ns() const noexcept { return read_ns(CLOCK_MONOTONIC); }

std::int64_t MonotonicClock::utc_us() const noexcept { return read_ns(CLOCK_REALTIME) / 1000; }

void MonotonicClock::sleep_until_ns(std::int64_t time_ns) noexcept {
  timespec t{};
  t.tv_sec = time_ns / kNsPerS;
  t.tv_nsec = time_ns % kNsPerS;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

}  // namespace monitor::rt
