// The daemon in real time: signals, privileges, the pace of a replay.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"

namespace program {
namespace {

using testing::HasSubstr;

std::vector<std::string> realtime_run(const std::string& config, const std::filesystem::path& log,
                                      const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"--config", config,  "--lcm-url",
                                        "",         "--set", "recorder.folder=" + log.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// Waits, ten seconds at most, until the log holds something.
void wait_for_data(const std::filesystem::path& log) {
  for (int i = 0; i < 1000; ++i) {
    std::error_code ignored;
    if (std::filesystem::exists(log, ignored) && !read_log(log).samples.empty()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  FAIL() << "no data in the log";
}

TEST(RealtimeDaemon, EndsAtNullWithExitCode0WhenASignalStopsIt) {
  for (const int signal : {SIGTERM, SIGINT}) {
    const Folder folder;
    const auto log_folder = folder.path() / "log";
    Daemon daemon(
        realtime_run(shipped("thesis_case1.toml"), log_folder, {"--set", "valve.null_V=0.25"}));
    wait_for_data(log_folder);
    kill(daemon.pid(), signal);
    const Result result = daemon.wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Log log = read_log(log_folder);
    ASSERT_FALSE(log.samples.empty());
    EXPECT_EQ(log.samples.front().state, 3);
    EXPECT_EQ(log.samples.back().state, 1);
    EXPECT_DOUBLE_EQ(log.samples.back().u_applied_V, 0.25);
    EXPECT_EQ(log.healths.back().ticks, static_cast<std::int64_t>(log.samples.size()));
  }
}

TEST(RealtimeDaemon, SaysWhatPrivilegesItGotAndGoesOnWhereItOnlyTries) {
  const Folder folder;
  const Result tried =
      run(realtime_run(shipped("demo.toml"), folder.path() / "log", {"--duration", "0.3"}),
          {.without_realtime = true});
  EXPECT_EQ(tried.exit_code, 0) << tried.err;
  EXPECT_THAT(tried.err, HasSubstr("no SCHED_FIFO"));
  EXPECT_THAT(read_log(folder.path() / "log").healths.back().privileges,
              HasSubstr("no SCHED_FIFO"));
}

TEST(RealtimeDaemon, DoesNotStartWithoutThePrivilegesItRequires) {
  const Folder folder;
  const Result result = run(realtime_run(shipped("demo.toml"), folder.path() / "log",
                                         {"--duration", "0.3", "--set", "loop.privileges=require"}),
                            {.without_realtime = true});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_THAT(result.err, HasSubstr("[loop] privileges"));
  EXPECT_TRUE(read_log(folder.path() / "log").samples.empty()) << "it ran before it refused";
}

TEST(RealtimeDaemon, ACrashStaysVisibleAsOne) {
  const Folder folder;
  const auto log_folder = folder.path() / "log";
  Daemon daemon(realtime_run(shipped("thesis_case1.toml"), log_folder, {}));
  wait_for_data(log_folder);
  kill(daemon.pid(), SIGABRT);
  EXPECT_EQ(daemon.wait().exit_code, -SIGABRT);
}

TEST(RealtimeDaemon, OutlivesABrokenPipe) {
  const Folder folder;
  const auto log_folder = folder.path() / "log";
  Daemon daemon(realtime_run(shipped("thesis_case1.toml"), log_folder, {}));
  wait_for_data(log_folder);
  kill(daemon.pid(), SIGPIPE);
  kill(daemon.pid(), SIGXFSZ);
  kill(daemon.pid(), SIGTERM);
  EXPECT_EQ(daemon.wait().exit_code, 0);
}

TEST(RealtimeDaemon, ReplaysAtTheRecordedPace) {
  const Folder folder;
  const std::string record = (folder.path() / "record.csv").string();
  std::ofstream out(record);
  out << "t_s,u_V,y_m\n";
  for (int i = 0; i < 50; ++i) out << i * 0.01 << ",0," << 0.001 * i << "\n";
  out.close();
  const auto start = std::chrono::steady_clock::now();
  const Result result = run(realtime_run(shipped("replay.toml"), folder.path() / "log",
                                         {"--set", "replay.record=" + record}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  // It can only be slower than the record, never faster: no assumption about the machine.
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(490));
  const Log log = read_log(folder.path() / "log");
  ASSERT_FALSE(log.samples.empty());
  for (const auto& s : log.samples) EXPECT_NEAR(s.y_m, 0.001 * static_cast<double>(s.tick), 1e-12);
}

}  // namespace
}  // namespace program
