#include "tests/soak/month_stand.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "config/record/log_reader.h"
#include "daemon/daemon_config.h"
#include "daemon/session.h"

namespace soak {
namespace {

/// The wall clock begins in 2023.
constexpr std::int64_t kEpoch_us = 1'700'000'000'000'000;
constexpr std::size_t kShortWrite = 50;
constexpr std::size_t kSequenceAt = 16;  // of a message: fingerprint, run_id, seq
constexpr const char* kUnlogged = " messages are not in the log";

std::int64_t sequence(const std::string& data) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    value = value << 8U | static_cast<unsigned char>(data[kSequenceAt + i]);
  }
  return static_cast<std::int64_t>(value);
}

/// The recorder's disk. Its troubles are of the moment that the clock shows.
struct Disk {
  const UnevenClock* clock = nullptr;  ///< null: a disk that works
  const MonthPlan* plan = nullptr;
  std::string folder;
  std::size_t next = 0;
  Logged logged;
  std::map<std::string, std::int64_t> newest;  ///< sequence number by channel

  [[nodiscard]] std::string path(int file) const {
    char link[64];
    char name[4096];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    const ssize_t n = readlink(link, name, sizeof name);
    return n > 0 ? std::string(name, static_cast<std::size_t>(n)) : "";
  }
  [[nodiscard]] bool holds(const std::string& name) const { return name.starts_with(folder); }

  const DiskFault* trouble(int file) {
    if (clock == nullptr) return nullptr;
    const std::int64_t now_ns = clock->now_ns();
    while (next < plan->disk.size() && plan->disk[next].to_ns <= now_ns) ++next;
    if (next == plan->disk.size() || plan->disk[next].from_ns > now_ns) return nullptr;
    return holds(path(file)) ? &plan->disk[next] : nullptr;
  }

  /// Counts a log that nothing more is written to.
  void closed(const std::string& name) {
    ++logged.files;
    config::record::LogReader reader(name);
    while (const config::record::LogEvent* event = reader.next()) {
      ++logged.messages[event->channel];
      const std::int64_t seq = sequence(event->data);
      const auto before = newest.find(event->channel);
      if (before != newest.end() && seq <= before->second) ++logged.out_of_turn;
      newest[event->channel] = seq;
    }
    if (!reader.at_end()) ++logged.partial;
  }
};

Disk disk;

}  // namespace

std::int64_t UnevenClock::utc_us() const noexcept {
  while (step_ < plan_.steps.size() && plan_.steps[step_].at_ns <= now_ns_) ++step_;
  return kEpoch_us + now_ns_ / 1000 + (step_ == 0 ? 0 : plan_.steps[step_ - 1].offset_us);
}

void UnevenClock::sleep_until_ns(std::int64_t time_ns) noexcept {
  if (time_ns > now_ns_) now_ns_ = time_ns;
  while (next_ < plan_.late.size() && plan_.late[next_].at_ns <= now_ns_) {
    now_ns_ += plan_.late[next_].late_ns;
    ++next_;
  }
}

int run_stand(const StandOptions& options, const MonthPlan& plan) {
  std::ofstream report(options.report);
  try {
    UnevenClock clock(plan);
    monitor::DaemonConfig config;
    monitor::SessionOptions session;
    session.virtual_time = true;
    session.clock = &clock;
    session.duration_s = options.duration_s;
    session.read = [&](monitor::DaemonConfig& target) {
      monitor::load(options.config, options.assignments, target);
      target.lcm.url = options.lcm_url;
    };
    session.read(config);
    disk.plan = &plan;
    disk.folder = options.log.string() + "/";
    disk.clock = &clock;
    const int code = monitor::run_session(config, session, report);
    disk.clock = nullptr;
    for (const auto& [channel, messages] : disk.logged.messages) {
      report << "logged " << channel << ' ' << messages << '\n';
    }
    report << "logged files " << disk.logged.files << "\nlogged out_of_turn "
           << disk.logged.out_of_turn << "\nlogged partial " << disk.logged.partial << '\n';
    return code;
  } catch (const std::exception& e) {
    report << e.what() << '\n';
    return 1;
  }
}

std::map<std::string, std::int64_t> read_report(const std::filesystem::path& report) {
  std::map<std::string, std::int64_t> values;
  std::ifstream in(report);
  for (std::string line; std::getline(in, line);) {
    const std::size_t said = line.find(kUnlogged);
    if (said != std::string::npos) {
      values["unlogged"] = std::stoll(line.substr(line.rfind(' ', said - 1) + 1));
    }
    std::istringstream words(line);
    std::string first;
    std::string name;
    std::int64_t value = 0;
    if (words >> first >> name >> value && first == "logged") values[name] = value;
  }
  return values;
}

}  // namespace soak

// In place of the C library's, for all of this program.
extern "C" ssize_t write(int file, const void* bytes, size_t count) {
  const soak::DiskFault* fault = soak::disk.trouble(file);
  if (fault != nullptr && fault->trouble != soak::DiskTrouble::short_writes) {
    errno = fault->trouble == soak::DiskTrouble::full ? ENOSPC : EIO;
    return -1;
  }
  if (fault != nullptr) count = std::min<std::size_t>(count, soak::kShortWrite);
  return syscall(SYS_write, file, bytes, count);
}

extern "C" int close(int file) {
  const bool watched = soak::disk.plan != nullptr;
  const std::string name = watched ? soak::disk.path(file) : "";
  const int result = static_cast<int>(syscall(SYS_close, file));
  if (watched && soak::disk.holds(name) && name.ends_with(".lcmlog")) soak::disk.closed(name);
  return result;
}
