// spoolwatchd: the daemon that runs a servo-hydraulic test stand and watches it for faults.
#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "config/schema/error.h"
#include "daemon/null_guard.h"
#include "daemon/rt/privileges.h"
#include "daemon/session.h"

namespace {

using config::schema::ExitCode;

constexpr double kShortest_s = 1e-3;
constexpr double kLongest_s = 1e9;

/// Where the caller closed a standard stream, a file opened later must not take its place.
void keep_standard_streams() {
  int file = 0;
  do {
    file = open("/dev/null", O_RDWR);
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file >= 0) close(file);
}

int run(int argc, char** argv) {
  CLI::App app("Runs a servo-hydraulic test stand and watches it for faults.", "spoolwatchd");
  std::string file;
  std::string clock = "realtime";
  std::string lcm_url;
  std::vector<std::string> assignments;
  monitor::SessionOptions options;
  bool check = false;
  app.add_option("--config", file, "configuration (TOML)")->required();
  app.add_option("--clock", clock, "virtual: as fast as possible, deterministic")
      ->check(CLI::IsMember({"realtime", "virtual"}));
  const CLI::Option* duration = app.add_option("--duration", options.duration_s,
                                               "seconds to run; without it, until a signal");
  CLI::Option* url = app.add_option("--lcm-url", lcm_url, "instead of [lcm] url");
  app.add_option("--set", assignments, "table.key=value, instead of the file's")
      ->allow_extra_args(false);
  app.add_flag("--check", check, "validate, print the effective configuration, write nothing");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? static_cast<int>(ExitCode::done) : static_cast<int>(ExitCode::usage);
  }
  if (duration->count() > 0 &&
      !(options.duration_s >= kShortest_s && options.duration_s <= kLongest_s)) {
    throw config::schema::Error(ExitCode::usage, "--duration: is " + duration->results().front() +
                                                     "; allowed: 0.001 to 1e9 (seconds)");
  }
  options.virtual_time = clock == "virtual";

  monitor::DaemonConfig config;
  monitor::load(file, assignments, config);
  if (url->count() > 0) config.lcm.url = lcm_url;
  if (check) {
    monitor::check_session(config, std::cout);
    return static_cast<int>(ExitCode::done);
  }
  return monitor::run_session(config, options, std::cerr);
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  monitor::outlive_failed_writes();
  monitor::rt::keep_memory_small();
  try {
    return run(argc, argv);
  } catch (const config::schema::Error& e) {
    std::cerr << "spoolwatchd: " << e.what() << '\n';
    return e.exit_code();
  } catch (const std::exception& e) {
    std::cerr << "spoolwatchd: " << e.what() << '\n';
    return static_cast<int>(ExitCode::failed);
  }
}
