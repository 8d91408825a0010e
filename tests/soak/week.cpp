#include "tests/soak/week.h"

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/soak/event_pipe.h"
#include "tests/soak/fault_plan.h"
#include "tests/soak/process.h"
#include "tests/soak/stream_check.h"

namespace soak {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr std::int64_t kPeriod_ns = 5'000'000;
constexpr double kLook_s = 60.0;           // of simulated time, between two looks at the memory
constexpr double kProgress_s = 10.0;       // of real time
constexpr std::int64_t kGrowth_KiB = 256;  // allowed after the first hour
constexpr std::int64_t kFileBytes = 4 << 20;
constexpr std::int64_t kFiles = 4;

/// The complaint about the recorder's folder; empty: none. One file more is there for the
/// moment between the new one and the oldest's removal.
std::string rotation_problem(const fs::path& folder) {
  std::int64_t files = 0;
  std::int64_t bytes = 0;
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(folder, gone)) {
    const auto size = entry.file_size(gone);
    if (gone) continue;
    ++files;
    bytes += static_cast<std::int64_t>(size);
  }
  if (files <= kFiles + 1 && bytes <= (kFiles + 1) * kFileBytes) return "";
  return "the recorder keeps " + std::to_string(files) + " files of " + std::to_string(bytes) +
         " bytes";
}

/// Requires of the files that are left the last samples, without a gap.
std::string tail_problem(const fs::path& folder, std::int64_t samples) {
  const program::Log log = program::read_log(folder);
  if (log.samples.empty()) return "the log is empty";
  if (log.samples.back().seq != samples - 1) return "the log does not end with the last sample";
  for (std::size_t i = 1; i < log.samples.size(); ++i) {
    if (log.samples[i].seq != log.samples[i - 1].seq + 1) return "the log has a gap";
  }
  return "";
}

std::string clock_time(double in_s) {
  const std::time_t when = std::time(nullptr) + std::lround(in_s);
  std::ostringstream out;
  out << std::put_time(std::localtime(&when), "%H:%M:%S");
  return out.str();
}

void print_figures(const StreamCheck& check, std::ostream& out) {
  for (const AlarmWatch& alarm : check.alarms()) {
    out << "  " << alarm.name() << ": came " << alarm.comings() << " times, at the latest "
        << alarm.slowest_on_s() << " s after the first moment it could, gone after "
        << alarm.slowest_off_s() << " s\n";
  }
  for (const Coefficient& c : check.coefficients()) {
    out << "  " << c.source << '.' << c.name << " healthy, first hour " << std::setprecision(7)
        << c.first.mean << " +- " << std::setprecision(2) << c.first.deviation() << ", last hour "
        << std::setprecision(7) << c.last.mean << " +- " << std::setprecision(2)
        << c.last.deviation() << '\n';
  }
  out << std::setprecision(6);
}

}  // namespace

WeekResult run_week(const WeekOptions& options, std::ostream& out) {
  const double duration_s = std::round(options.hours * 3600.0);
  const std::vector<Fault> faults = random_faults(options.seed, duration_s);
  const program::Folder folder;
  const fs::path file = folder.path() / "week.toml";
  const fs::path pipe = folder.path() / "messages";
  const fs::path log = folder.path() / "log";
  std::ofstream(file) << configuration(options.config, faults);
  if (mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("cannot make a pipe");
  const fs::path model = fs::absolute(options.config).parent_path() / "models";

  std::vector<std::string> words{
      "--config",   file.string(),
      "--clock",    "virtual",
      "--duration", std::to_string(static_cast<std::int64_t>(duration_s)),
      "--lcm-url",  "file://" + pipe.string() + "?mode=w",
      "--set",      "sim.model=" + (model / "thesis_calibrated.toml").string(),
      "--set",      "sim.seed=" + std::to_string(options.seed % 1'000'000'007)};
  if (options.record) {
    for (const std::string& set :
         {"recorder.folder=" + log.string(), "recorder.file_bytes=" + std::to_string(kFileBytes),
          "recorder.files=" + std::to_string(kFiles)}) {
      words.insert(words.end(), {"--set", set});
    }
  }
  words.insert(words.end(), options.more.begin(), options.more.end());
  out << "seed " << options.seed << ": " << options.hours << " h with " << faults.size()
      << " faults" << (options.record ? ", recorded" : "") << std::endl;

  const auto start = steady_clock::now();
  const auto passed_s = [&] {
    return std::chrono::duration<double>(steady_clock::now() - start).count();
  };
  program::Daemon daemon(words);
  EventPipe events(pipe, [&] { return runs(daemon.pid()); });
  WeekResult result;
  StreamCheck check(faults, duration_s, kPeriod_ns);
  const double settled_s = std::min(3600.0, duration_s / 2.0);
  double look_s = kLook_s;
  double tell_s = kProgress_s;
  std::int64_t bytes = 0;
  while (events.next()) {
    bytes += static_cast<std::int64_t>(events.data().size());
    check.take(events.channel(), events.data().data(), static_cast<int>(events.data().size()));
    if (check.time_s() < look_s) continue;
    look_s += kLook_s;
    const std::int64_t now_KiB = resident_KiB(daemon.pid());
    if (check.time_s() <= settled_s) {
      result.resident_first_KiB = std::max(result.resident_first_KiB, now_KiB);
    }
    result.resident_last_KiB = std::max(result.resident_last_KiB, now_KiB);
    if (options.record) {
      const std::string wrong = rotation_problem(log);
      if (!wrong.empty()) result.problems.push_back(wrong);
    }
    if (passed_s() < tell_s) continue;
    tell_s = passed_s() + kProgress_s;
    const double left_s = passed_s() * (duration_s / check.time_s() - 1.0);
    out << "  " << std::fixed << std::setprecision(1) << check.time_s() / 3600.0 << " h of "
        << options.hours << ", resident " << now_KiB << " KiB, " << check.problem_count()
        << " problems; ends at " << clock_time(left_s) << std::defaultfloat << std::setprecision(6)
        << std::endl;
  }
  const program::Result ended = daemon.wait();
  check.finish();
  result.wall_s = passed_s();
  result.samples = check.samples();
  result.faults = faults.size();
  for (const AlarmWatch& alarm : check.alarms()) {
    result.comings += static_cast<std::int64_t>(alarm.comings());
  }
  const auto add = [&](const std::string& problem) {
    if (!problem.empty()) result.problems.push_back(problem);
  };
  if (ended.exit_code != 0) {
    add("spoolwatchd ended with " + std::to_string(ended.exit_code) + ": " + ended.err);
  }
  if (result.resident_last_KiB > result.resident_first_KiB + kGrowth_KiB) {
    add("its memory has grown by " +
        std::to_string(result.resident_last_KiB - result.resident_first_KiB) + " KiB, allowed " +
        std::to_string(kGrowth_KiB));
  }
  if (options.record) add(tail_problem(log, check.samples()));
  result.problem_count = static_cast<std::int64_t>(result.problems.size()) + check.problem_count();
  result.problems.insert(result.problems.end(), check.problems().begin(), check.problems().end());
  print_figures(check, out);
  out << "  memory " << result.resident_first_KiB << " KiB in the first " << settled_s / 3600.0
      << " h, at most " << result.resident_last_KiB << " KiB later\n  " << result.samples
      << " samples, " << bytes / 1'000'000 << " MB of messages in " << result.wall_s
      << " s: " << duration_s / result.wall_s << " times real time\n";
  for (const std::string& problem : result.problems) out << "  WRONG " << problem << '\n';
  out << (result.problem_count == 0 ? "  all of it right"
                                    : "  " + std::to_string(result.problem_count) + " problems")
      << std::endl;
  return result;
}

}  // namespace soak
