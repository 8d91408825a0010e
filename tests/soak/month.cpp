#include "tests/soak/month.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/daemon/program/subprocess.h"
#include "tests/soak/event_pipe.h"
#include "tests/soak/fault_plan.h"
#include "tests/soak/month_check.h"
#include "tests/soak/month_stand.h"
#include "tests/soak/process.h"

namespace soak {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr std::int64_t kPeriod_ns = 5'000'000;
constexpr double kLook_s = 60.0;           // of simulated time, between two looks
constexpr double kProgress_s = 20.0;       // of real time
constexpr std::int64_t kGrowth_KiB = 512;  // allowed after the first hours
constexpr double kFirst_s = 6.0 * 3600.0;  // every kind of fault has been there
constexpr std::int64_t kFileBytes = 4 << 20;
constexpr std::int64_t kFiles = 4;
constexpr std::int64_t kPacks = 5;
constexpr double kBetweenStops = 2e6;  // messages between two stops of the peer, on average

constexpr const char* kGuards = R"(
[[guard]]
kind = "missing"
action = "indicate"
[[guard]]
kind = "bus_lost"
action = "indicate"
[[guard]]
kind = "stale"
age_s = 0.5
action = "indicate"
[[guard]]
kind = "frozen"
least_m = 1e-5
command_V = 0.5
time_s = 0.1
action = "indicate"
[[guard]]
kind = "jump"
limit_m = 5e-3
action = "indicate"
)";

std::int64_t files_in(const fs::path& folder) {
  std::error_code gone;
  std::int64_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder, gone)) ++files;
  return files;
}

/// Ended and waited for on every way out.
class Child {
 public:
  template <class Work>
  explicit Child(Work work) : pid_(fork()) {
    if (pid_ < 0) throw std::runtime_error("cannot start a process");
    if (pid_ == 0) _exit(work());
  }
  ~Child() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

 private:
  pid_t pid_;
};

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

}  // namespace

MonthResult run_month(const MonthOptions& options, std::ostream& out) {
  const double duration_s = std::round(options.hours * 3600.0);
  const MonthPlan plan(options.seed, duration_s);
  const program::Folder folder;
  const fs::path pipe = folder.path() / "messages";
  const fs::path evidence = folder.path() / "evidence";
  if (mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("cannot make a pipe");
  StandOptions stand;
  stand.config = folder.path() / "month.toml";
  stand.log = folder.path() / "log";
  stand.report = folder.path() / "report";
  stand.lcm_url = "file://" + pipe.string() + "?mode=w";
  stand.duration_s = duration_s;
  std::ofstream(stand.config) << configuration(options.config, {}) << kGuards << plan.as_toml();
  const fs::path model =
      fs::absolute(options.config).parent_path() / "models/thesis_calibrated.toml";
  stand.assignments = {"sim.model=" + model.string(),
                       "sim.seed=" + std::to_string(options.seed % 1'000'000'007),
                       "sim.command_timeout_s=0.1",
                       "loop.overrun_action=count",
                       "recorder.folder=" + stand.log.string(),
                       "recorder.file_bytes=" + std::to_string(kFileBytes),
                       "recorder.files=" + std::to_string(kFiles),
                       "evidence.folder=" + evidence.string(),
                       "evidence.packs=" + std::to_string(kPacks)};
  stand.assignments.insert(stand.assignments.end(), options.more.begin(), options.more.end());
  out << "seed " << options.seed << ": " << options.hours << " h with " << plan.devices.size()
      << " faults of devices, " << plan.late.size() << " late wake-ups, " << plan.steps.size()
      << " steps of the wall clock, " << plan.disk.size() << " troubles of the disk" << std::endl;

  const auto start = steady_clock::now();
  const auto passed_s = [&] {
    return std::chrono::duration<double>(steady_clock::now() - start).count();
  };
  Child child([&] { return run_stand(stand, plan); });
  EventPipe events(pipe, [&] { return runs(child.pid()); });
  MonthResult result;
  const auto add = [&](const std::string& problem) {
    ++result.problem_count;
    if (result.problems.size() < 20) result.problems.push_back(problem);
  };
  MonthCheck check(plan, duration_s, kPeriod_ns);
  std::mt19937_64 random(options.seed + 1);
  std::exponential_distribution<double> until_stop(1.0 / kBetweenStops);
  std::uniform_real_distribution<double> stopped_s(0.02, 0.3);
  const double first_s = std::min(kFirst_s, duration_s / 2.0);
  double look_s = kLook_s;
  double tell_s = kProgress_s;
  double stop_at = until_stop(random);
  double taken = 0.0;
  std::int64_t stops = 0, first_KiB = 0, most_KiB = 0;
  while (events.next()) {
    check.take(events.channel(), events.data().data(), static_cast<int>(events.data().size()));
    taken += 1.0;
    if (taken >= stop_at) {
      std::this_thread::sleep_for(std::chrono::duration<double>(stopped_s(random)));
      stop_at = taken + until_stop(random);
      ++stops;
    }
    if (check.time_s() < look_s) continue;
    look_s += kLook_s;
    const std::int64_t now_KiB = resident_KiB(child.pid());
    std::int64_t& most = check.time_s() <= first_s ? first_KiB : most_KiB;
    most = std::max(most, now_KiB);
    if (files_in(stand.log) > kFiles + 1) add("the recorder keeps more files than it may");
    if (files_in(evidence) > kPacks + 2) add("more evidence is kept than may be");
    if (passed_s() < tell_s) continue;
    tell_s = passed_s() + kProgress_s;
    out << "  " << check.time_s() / 3600.0 << " h of " << options.hours << ", resident " << now_KiB
        << " KiB, " << check.problem_count() + result.problem_count << " problems" << std::endl;
  }
  const int code = child.wait();
  const std::map<std::string, std::int64_t> report = read_report(stand.report);
  check.finish(report);
  // The daemon's exit code says whether messages are missing in its log.
  if (code != (check.unlogged() > 0 ? 1 : 0)) {
    add("the daemon ended with " + std::to_string(code) + ": " + text_of(stand.report));
  }
  if (most_KiB > first_KiB + kGrowth_KiB) {
    add("its memory has grown by " + std::to_string(most_KiB - first_KiB) + " KiB, allowed " +
        std::to_string(kGrowth_KiB));
  }
  result.problem_count += check.problem_count();
  result.problems.insert(result.problems.end(), check.problems().begin(), check.problems().end());
  result.samples = check.samples();
  result.lost_periods = check.lost_periods();
  result.sent = check.sent();
  result.unlogged = check.unlogged();
  const double wall_s = passed_s();
  out << "  " << result.samples << " samples, " << result.lost_periods
      << " periods lost as planned, " << check.comings() << " alarms\n  " << result.sent
      << " messages sent, " << result.sent - result.unlogged << " of them in " << report.at("files")
      << " logs, " << result.unlogged << " lost while the disk failed, each counted\n  memory "
      << first_KiB << " KiB in the first " << first_s / 3600.0 << " h, at most " << most_KiB
      << " KiB later; the peer stopped " << stops << " times; " << wall_s
      << " s: " << duration_s / wall_s << " times real time\n";
  for (const std::string& problem : result.problems) out << "  WRONG " << problem << '\n';
  out << (result.problem_count == 0 ? "  every message is accounted for"
                                    : "  " + std::to_string(result.problem_count) + " problems")
      << std::endl;
  return result;
}

}  // namespace soak
