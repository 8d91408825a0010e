#include "daemon/safe_state_note.h"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>
#include <ostream>
#include <thread>
#include <utility>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/device.h"

namespace monitor {
namespace {

using config::schema::RunError;

/// A device may still be closing the connection of the process that died.
constexpr std::chrono::seconds kRetryFor{2};
constexpr std::chrono::milliseconds kRetryEvery{100};

/// Writes null once. Returns an empty string or why that failed.
std::string try_null(const DaemonConfig& config, bool& nothing_to_do) {
  try {
    const std::shared_ptr<hal::ValveDrive> valve =
        config.rig.open_valve({config.file, config.folder, 1.0 / config.loop.rate_Hz,
                               config.rig.valve().null_V, config.rig.valve().limit_V});
    nothing_to_do = valve == nullptr;
    if (nothing_to_do || valve->end_at_null().good) return "";
    return config.file + ": [valve]: the device does not take null";
  } catch (const config::schema::ConnectionFailed& e) {
    return e.what();
  } catch (const RunError& e) {
    return e.what();
  }
}

}  // namespace

SafeStateNote::SafeStateNote(std::filesystem::path file, DaemonConfig& config)
    : file_(std::move(file)) {
  if (file_.empty()) return;
  const std::filesystem::path part = file_.string() + ".part";
  std::ofstream out(part);
  out << config::schema::print_toml([&](config::schema::Visitor& v) { config.visit(v); });
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(part, file_, error);
  if (!out || error) {
    throw RunError("--driving: " + file_.string() +
                   " cannot be written: " + (error ? error.message() : std::strerror(errno)));
  }
}

void SafeStateNote::withdraw() const {
  std::error_code ignored;
  if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

int write_null(const DaemonConfig& config, std::ostream& log) {
  const auto until = std::chrono::steady_clock::now() + kRetryFor;
  bool nothing_to_do = false;
  std::string wrong = try_null(config, nothing_to_do);
  while (!wrong.empty() && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(kRetryEvery);
    wrong = try_null(config, nothing_to_do);
  }
  if (!wrong.empty()) throw RunError(wrong);
  log << "spoolwatchd: "
      << (nothing_to_do ? "no valve can have been left away from null"
                        : "null written to the valve (" + config.rig.valve().backend + ")")
      << std::endl;
  return EXIT_SUCCESS;
}

int write_null(const std::filesystem::path& note, std::ostream& log) {
  std::error_code ignored;
  if (!std::filesystem::exists(note, ignored)) {
    log << "spoolwatchd: nothing is driven" << std::endl;
    return EXIT_SUCCESS;
  }
  DaemonConfig config;
  load(note, {}, config);
  const int exit_code = write_null(config, log);
  std::filesystem::remove(note, ignored);
  return exit_code;
}

}  // namespace monitor
