// A process that dies of a fatal signal, an exception or a normal exit has commanded null last.
#include "daemon/safe_state_valve.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "hal/thread.h"

namespace monitor {
namespace {

/// Tells another process what is written: 'u' for a voltage, 'n' for null.
class PipeValve final : public hal::ValveDrive {
 public:
  explicit PipeValve(int pipe) : pipe_(pipe) {}
  hal::Applied write(double u_V, const hal::Tick&) noexcept override { return tell('u', u_V); }
  hal::Applied go_null() noexcept override { return tell('n', 0.0); }

 private:
  hal::Applied tell(char what, double u_V) const noexcept {
    return {u_V, ::write(pipe_, &what, 1) == 1};
  }
  int pipe_;
};

/// The voltages that a child process wrote to its valve; `end` ends it.
template <class End>
std::string writes_of_child(End end, int& status) {
  int ends[2];
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    PipeValve valve(ends[1]);
    const SafeStateValve guard(&valve);
    valve.write(1.0, {});
    end();
    _exit(0);  // leaves the guard out
  }
  close(ends[1]);
  std::string all;
  char c = 0;
  while (read(ends[0], &c, 1) == 1) all += c;
  close(ends[0]);
  waitpid(child, &status, 0);
  return all;
}

TEST(SafeStateValve, CommandsNullWhenAFatalSignalComes) {
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGQUIT, SIGXCPU, SIGSYS,
                           SIGTRAP, SIGUSR1, SIGUSR2, SIGALRM, SIGPROF, SIGVTALRM, SIGIO}) {
    int status = 0;
    EXPECT_EQ(writes_of_child([signal] { raise(signal); }, status), "un");
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_EQ(WTERMSIG(status), signal);
  }
}

/// Uses up any stack.
int overflow(int depth) {  // NOLINT(misc-no-recursion)
  volatile char frame[4096];
  frame[0] = static_cast<char>(depth);
  return depth < 0 ? 0 : overflow(depth + 1) + frame[0];
}

TEST(SafeStateValve, CommandsNullWhenTheStackOfAnyThreadOverflows) {
  int status = 0;
  EXPECT_EQ(writes_of_child([] { overflow(0); }, status), "un");
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(writes_of_child(
                [] {
                  hal::Thread thread;
                  thread.start("deep", {}, [] { overflow(0); });
                },
                status),
            "un");
  EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(SafeStateValve, CommandsNullWhenAnExceptionEndsTheProcess) {
  int status = 0;
  EXPECT_EQ(writes_of_child([] { std::terminate(); }, status), "un");
  EXPECT_EQ(WTERMSIG(status), SIGABRT);
}

TEST(SafeStateValve, FollowsEveryLaterCommandByNull) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  PipeValve inner(ends[1]);
  {
    SafeStateValve guard(&inner);
    EXPECT_EQ(guard.valve()->write(1.0, {}).u_V, 1.0);
    guard.close();
    EXPECT_EQ(guard.valve()->write(1.0, {}).u_V, 0.0) << "what it says it applied";
  }
  close(ends[1]);
  char text[8] = {};
  EXPECT_EQ(read(ends[0], text, sizeof text), 5);
  EXPECT_STREQ(text, "ununn");
  close(ends[0]);
  EXPECT_EQ(SafeStateValve(nullptr).valve(), nullptr);
}

TEST(SafeStateValve, CommandsNullWhenTheScopeIsLeftAndNotAfterwards) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  PipeValve valve(ends[1]);
  { const SafeStateValve guard(&valve); }
  close(ends[1]);
  char text[8] = {};
  EXPECT_EQ(read(ends[0], text, sizeof text), 1);
  EXPECT_STREQ(text, "n");
  close(ends[0]);
}

}  // namespace
}  // namespace monitor
