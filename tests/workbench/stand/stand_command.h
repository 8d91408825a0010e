// `spoolwatch new stand` as a user types it, in a folder of its own, and what the daemon says of
// the file.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/daemon/program/subprocess.h"

namespace workbench_test {

using Flags = std::map<std::string, std::string>;

inline constexpr const char* kBackends[] = {"sim", "modbus", "comedi"};

/// The answers that must be given, and no other: a stand with 200 mm of travel.
inline Flags least_flags(const std::string& backend) {
  Flags flags{
      {"backend", backend}, {"low-mm", "200"}, {"high-mm", "400"}, {"max-speed-mmps", "450"}};
  if (backend == "sim") {
    flags["model"] = SPOOLWATCH_SOURCE_DIR "/config/models/thesis_calibrated.toml";
  } else if (backend == "modbus") {
    flags.insert({{"address", "127.0.0.1:1"},  // where nothing listens
                  {"position-register", "4"},
                  {"position-type", "float32"},
                  {"position-mm-per-count", "1000"},
                  {"command-register", "2"},
                  {"command-type", "float32"},
                  {"command-V-per-count", "1"},
                  {"watchdog-ms", "50"}});
  } else {
    flags.insert({{"line-a", "2"},
                  {"line-b", "3"},
                  {"resolution-um", "100"},
                  {"chip", "no_such_chip"},
                  {"permit-line", "8"}});
  }
  return flags;
}

/// The same with supply and chamber pressures.
inline Flags pressure_flags(const std::string& backend) {
  Flags flags = least_flags(backend);
  flags.insert({{"pressures", "all"}, {"supply-low-bar", "100"}, {"supply-high-bar", "160"}});
  if (backend == "modbus") {
    flags.insert({{"supply-register", "15"},
                  {"pressure-in-register", "16"},
                  {"pressure-out-register", "17"},
                  {"pressure-type", "int16"},
                  {"pressure-bar-per-count", "0.01"}});
  } else if (backend == "comedi") {
    flags.insert({{"supply-channel", "3"},
                  {"pressure-in-channel", "4"},
                  {"pressure-out-channel", "5"},
                  {"pressure-bar-per-V", "40"}});
  }
  return flags;
}

inline std::string words(const Flags& flags) {
  std::string text;
  for (const auto& [flag, value] : flags) text += " --" + flag + " '" + value + "'";
  return text;
}

/// `spoolwatchd --check` takes the file, or all of it but a device that is not there.
inline bool daemon_takes(const std::string& file) {
  const program::Result check = program::run({"--config", file, "--check"});
  return check.exit_code == 0 ||
         (check.exit_code == 78 &&
          check.err.find("everything that can be checked without the device is valid") !=
              std::string::npos);
}

/// A run of the command; its file goes away with the object.
class NewStand {
 public:
  explicit NewStand(const Flags& flags, const std::string& more = " < /dev/null")
      : result_(program::spoolwatch("new stand -o " + file() + words(flags) + more)) {}

  [[nodiscard]] std::string file() const { return (folder_.path() / "stand.toml").string(); }
  [[nodiscard]] int exit_code() const { return result_.exit_code; }
  [[nodiscard]] const std::string& out() const { return result_.out; }
  /// Exit code 2, one line, and nothing in the folder.
  [[nodiscard]] bool refused() const {
    return exit_code() == 2 && std::count(out().begin(), out().end(), '\n') == 1 &&
           std::filesystem::is_empty(folder_.path());
  }
  [[nodiscard]] std::string text() const {
    std::ostringstream text;
    text << std::ifstream(file()).rdbuf();
    return text.str();
  }
  [[nodiscard]] bool passes_check() const { return daemon_takes(file()); }

 private:
  program::Folder folder_;
  program::Result result_;
};

}  // namespace workbench_test
