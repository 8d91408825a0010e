// The loop's calls make no system call: the thread knows by itself when to look. Counted by the
// kernel (seccomp), in a thread that may only read the time and sleep.
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <thread>
#include <vector>

#include "tests/hal/modbus/servo.h"

namespace hal::modbus {
namespace {

constexpr std::int64_t kTicks = 30;

thread_local volatile sig_atomic_t calls = 0;

void count_call(int) { calls = calls + 1; }

/// From now on this thread's other system calls are counted and not carried out. False where the
/// kernel does not do that.
bool forbid_system_calls() {
  struct sigaction action {};
  action.sa_handler = count_call;
  sigaction(SIGSYS, &action, nullptr);
  std::vector<sock_filter> filter{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr))};
  for (const unsigned allowed : {SYS_clock_gettime, SYS_gettimeofday, SYS_clock_nanosleep,
                                 SYS_rt_sigreturn, SYS_rt_sigprocmask, SYS_madvise, SYS_exit}) {
    filter.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, allowed, 0, 1));
    filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  }
  filter.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP));
  const sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

enum class Ticks { quiet, disturbed, not_possible };

/// Half a second of a loop that reads, writes and sets its permit. Disturbed: a tick came so late
/// that it had to wake the thread.
Ticks run_loop(const BackendDevices& devices) {
  RodSensor& rod = *devices.rods.at("position");
  Output& permit = *devices.outputs.at("permit");
  const std::int64_t start_ns = monotonic_ns();
  std::int64_t before_ns = start_ns;
  for (std::int64_t i = 0; i < kTicks; ++i) {
    const Tick tick{i, i * 20'000'000};
    const std::int64_t due_ns = start_ns + tick.nominal_ns;
    const timespec due{due_ns / 1'000'000'000, due_ns % 1'000'000'000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr);
    if (monotonic_ns() - before_ns > 50'000'000) return Ticks::disturbed;
    if (i == 2 && !forbid_system_calls()) return Ticks::not_possible;  // the first wakes the thread
    before_ns = monotonic_ns();
    rod.read(tick);
    devices.valve->write(static_cast<double>(i) * 0.1, tick);
    permit.set(i % 2 == 0);
  }
  return Ticks::quiet;
}

TEST(ModbusSystemCalls, NoneInATickThatComesAfterAnother) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizers make calls of their own";
#endif
  Ticks ran = Ticks::disturbed;
  for (int attempt = 0; attempt < 20 && ran == Ticks::disturbed; ++attempt) {
    Device device;
    const BackendDevices devices =
        open_text(tcp(device, "", "[modbus.registers.permit]\nrole = \"output\"\naddress = 6\n"));
    int counted = 0;
    std::thread loop([&] {
      ran = run_loop(devices);
      counted = calls;
    });
    loop.join();
    if (ran != Ticks::quiet) continue;
    EXPECT_EQ(counted, 0);
    const auto sent = [&] {
      const auto writes = device.writes();
      return std::any_of(writes.begin(), writes.end(), [](const Received& write) {
        return write.address == kCommand && write.words[0] == 100 * (kTicks - 1);
      });
    };
    EXPECT_TRUE(eventually(sent)) << "the last command";
  }
  std::signal(SIGSYS, SIG_DFL);
  if (ran != Ticks::quiet) GTEST_SKIP() << "no seccomp here, or the machine is never quiet";
}

}  // namespace
}  // namespace hal::modbus
