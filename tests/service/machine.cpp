#include "tests/service/machine.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/daemon/program/subprocess.h"

namespace service {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

/// The inner number of a process in that pid namespace, 0 when it is not in it.
pid_t inner_pid(const std::filesystem::path& process, const std::string& space) {
  std::error_code error;
  if (std::filesystem::read_symlink(process / "ns/pid", error).string() != space) return 0;
  std::ifstream in(process / "status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("NSpid:")) return std::stoi(line.substr(line.rfind('\t') + 1));
  }
  return 0;
}

}  // namespace

Machine::Machine() {
  const char* init = std::getenv("SPOOLWATCH_CONTAINER");
  init_ = init == nullptr ? "" : init;
}

Output Machine::run(const std::string& command) const {
  const program::Result result = program::shell("nsenter -t " + init_ + " -a -- /bin/sh -c " +
                                                quoted(command) + " </dev/null");
  return {result.exit_code, result.out};
}

std::string Machine::property(const std::string& name) const {
  std::string value = run("systemctl show --value -p " + name + " spoolwatchd").text;
  while (!value.empty() && value.back() == '\n') value.pop_back();
  return value;
}

bool Machine::becomes(const std::string& name, const std::string& begin) const {
  for (int i = 0; i < 200; ++i) {
    if (property(name).starts_with(begin)) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

pid_t Machine::daemon() const {
  const pid_t main = std::atoi(property("MainPID").c_str());
  if (main == 0) return 0;
  std::error_code error;
  const std::string space =
      std::filesystem::read_symlink("/proc/" + init_ + "/ns/pid", error).string();
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    const pid_t outer = std::atoi(entry.path().filename().c_str());
    if (outer > 0 && inner_pid(entry.path(), space) == main) return outer;
  }
  return 0;
}

std::int64_t Machine::stopped_ns() const {
  return std::atoll(property("ActiveExitTimestampMonotonic").c_str()) * 1000;
}

std::int64_t Machine::logged_ns(const std::string& words) const {
  const std::string text = run("journalctl --output=json --no-pager -b | grep '" + words +
                               "' | tail -1 | "
                               "sed 's/.*\"_SOURCE_REALTIME_TIMESTAMP\":\"\\([0-9]*\\)\".*/\\1/'")
                               .text;
  using std::chrono::duration_cast;
  using std::chrono::nanoseconds;
  const auto since_boot = std::chrono::steady_clock::now().time_since_epoch();
  const auto utc = std::chrono::system_clock::now().time_since_epoch();
  return std::atoll(text.c_str()) * 1000 - duration_cast<nanoseconds>(utc - since_boot).count();
}

void Machine::write(const std::string& path, const std::string& text) const {
  std::ofstream("/proc/" + init_ + "/root" + path) << text;
}

}  // namespace service
