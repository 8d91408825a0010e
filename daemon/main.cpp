// spoolwatchd: the daemon that runs a servo-hydraulic test stand and watches it for faults.
#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <new>

#include "config/schema/error.h"
#include "config/schema/product_version.h"
#include "config/schema/spelling.h"
#include "daemon/commission.h"
#include "daemon/daemon_config.h"
#include "daemon/rt/privileges.h"
#include "daemon/safe_state_note.h"
#include "daemon/safe_state_valve.h"
#include "daemon/session.h"

namespace {

constexpr double kShortest_s = 1e-3;
constexpr double kLongest_s = 1e9;

/// Opens standard streams that the caller closed, so that no later file takes their descriptors.
void keep_standard_streams() {
  int file = 0;
  do {
    file = open("/dev/null", O_RDWR);
  } while (file >= 0 && file <= STDERR_FILENO);
  if (file >= 0) close(file);
}

/// --commission and its options; lengths are in mm on the command line.
const CLI::Option* add_commission(CLI::App& app, monitor::CommissionOptions& options) {
  constexpr double kMetresPerMillimetre = 1e-3;
  const auto millimetres = [&app](const char* name, const char* what, double low_mm, double high_mm,
                                  double& target_m) {
    return app
        .add_option_function<double>(
            name, [&target_m](const double& mm) { target_m = mm * kMetresPerMillimetre; }, what)
        ->check(CLI::Range(low_mm, high_mm));
  };
  CLI::Option* out = app.add_option("--commission", options.out,
                                    "commission the rig and write this calibration file");
  CLI::Option* more[] = {
      millimetres("--max-travel-mm", "limit of rod travel in a stage, default 5", 0.1, 1000.0,
                  options.max_travel_m),
      millimetres("--max-speed-mmps", "limit of rod speed, default --max-travel-mm in 0.1 s", 0.1,
                  10000.0, options.max_speed_mps),
      app.add_option("--authority", options.authority_V,
                     "largest deviation of the command from null, V")
          ->check(CLI::Range(1e-3, 100.0)),
      app.add_option("--pulse", options.pulse_s, "duration of a pulse, s")
          ->check(CLI::Range(0.05, 10.0)),
      app.add_option("--home", options.home, "reference position to drive to at the end")
          ->check(
              CLI::IsMember({"none", "stop_above", "stop_below", "index_above", "index_below"})),
      millimetres("--home-travel-mm", "limit of travel on the way there, default 1000", 1.0,
                  100000.0, options.home_travel_m),
      millimetres("--stroke-mm",
                  "true distance between the stops; drives to both to find the scale", 1.0,
                  100000.0, options.stroke_m),
      app.add_flag("--yes", options.yes, "start each motion without asking")};
  for (CLI::Option* option : more) option->needs(out)->group("Commissioning");
  out->group("Commissioning");
  return out;
}

int run(int argc, char** argv) {
  CLI::App app("Runs a servo-hydraulic test stand and watches it for faults.", "spoolwatchd");
  app.set_version_flag("--version",
                       "spoolwatchd " + std::string(config::schema::product_version()));
  std::string file;
  std::string clock = "realtime";
  std::string lcm_url;
  std::vector<std::string> assignments;
  monitor::SessionOptions options;
  bool check = false;
  bool null = false;
  const CLI::Option* configuration = app.add_option("--config", file, "configuration (TOML)");
  app.add_option("--clock", clock, "realtime, or virtual: deterministic and as fast as possible")
      ->check(CLI::IsMember({"realtime", "virtual"}));
  const CLI::Option* duration =
      app.add_option("--duration", options.duration_s, "seconds to run; default: until a signal");
  CLI::Option* url = app.add_option("--lcm-url", lcm_url, "overrides [lcm] url");
  app.add_option("--set", assignments, "table.key=value, overrides the file")
      ->allow_extra_args(false);
  app.add_flag("--check", check,
               "validate without writing to a device; print the effective configuration and the "
               "consequence of each failure; exit code 78 also for an unreachable device");
  const CLI::Option* note =
      app.add_option("--driving", options.driving,
                     "note of the driven valve; the file exists while the valve is driven");
  app.add_flag("--null", null,
               "only write null; with --driving: only if a daemon that died left "
               "that file");
  bool reference = false;
  app.add_flag("--configuration-reference", reference)->group("");  // hidden: scripts/reference
  monitor::CommissionOptions commission;
  const CLI::Option* out = add_commission(app, commission);
  try {
    app.parse(argc, argv);
    const bool from_note = null && note->count() > 0;
    if (configuration->count() == 0 && !from_note && !reference)
      throw CLI::RequiredError("--config");
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) {
      config::schema::require_known_options({argv + 1, argv + argc}, app);
    }
    return app.exit(e) == 0 ? EXIT_SUCCESS : config::schema::kUsageExitCode;
  }
  if (reference) {
    std::cout << monitor::configuration_reference();
    return EXIT_SUCCESS;
  }
  if (duration->count() > 0 &&
      !(options.duration_s >= kShortest_s && options.duration_s <= kLongest_s)) {
    throw config::schema::UsageError("--duration: is " + duration->results().front() +
                                     "; allowed: 0.001 to 1e9 (seconds)");
  }
  options.virtual_time = clock == "virtual";
  if (null && note->count() > 0) return monitor::write_null(options.driving, std::cerr);

  monitor::DaemonConfig config;
  options.read = [&](monitor::DaemonConfig& target) {
    monitor::load(file, assignments, target);
    if (url->count() > 0) target.lcm.url = lcm_url;
  };
  options.read(config);
  if (null) return monitor::write_null(config, std::cerr);
  if (check) {
    monitor::check_session(config, std::cout);
    return EXIT_SUCCESS;
  }
  if (out->count() > 0) {
    commission.virtual_time = options.virtual_time;
    return monitor::commission(config, commission, std::cout);
  }
  return monitor::run_session(config, options, std::cerr);
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_streams();
  monitor::ignore_write_signals();
  monitor::rt::keep_memory_small();
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "spoolwatchd: not enough memory for this input\n";
    return EXIT_FAILURE;
  } catch (const std::exception& e) {
    std::cerr << "spoolwatchd: " << e.what() << '\n';
    return config::schema::exit_code_of(e);
  }
}
