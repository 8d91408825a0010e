// spoolwatch-rig: the simulated rig in real time, as a separate Modbus server process.
#include <pthread.h>
#include <sched.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <iostream>
#include <optional>

#include "config/schema/error.h"
#include "config/schema/product_version.h"
#include "config/schema/reference.h"
#include "config/schema/spelling.h"
#include "hal/hil_rig/moved_lines.h"
#include "hal/hil_rig/register_map.h"
#include "hal/hil_rig/server.h"
#include "hal/monotonic.h"

namespace {

volatile std::sig_atomic_t stop_asked = 0;
void on_stop(int) { stop_asked = 1; }

struct RigOptions {
  std::string file;
  std::string listen;
  std::string serial;
  std::vector<std::string> assignments;
  double duration_s = 0.0;
};

int serve(const RigOptions& options, bool has_listen, bool has_serial) {
  hal::hil_rig::RigConfig config = hal::hil_rig::load(options.file, options.assignments);
  if (has_listen) config.bus.listen = options.listen == "0" ? "127.0.0.1:0" : options.listen;
  if (has_serial) config.bus.serial = options.serial;
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) std::signal(signal, on_stop);
  std::signal(SIGPIPE, SIG_IGN);

  const std::int64_t start_ns = hal::monotonic_ns();
  hal::hil_rig::BenchRig rig(config, start_ns);
  hal::hil_rig::Server server(config, rig);
  if (config.bus.priority > 0) {
    const sched_param parameters{static_cast<int>(config.bus.priority)};
    pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);  // else the normal class
  }
  if (!server.address().empty()) std::cout << "listening on " << server.address() << std::endl;
  if (!config.bus.serial.empty()) std::cout << "listening on " << config.bus.serial << std::endl;
  std::optional<hal::hil_rig::MovedLines> lines;
  if (config.gpio.present) {
    lines.emplace(config, rig);
    std::cout << "moving lines of " << config.gpio.chip << std::endl;
  }
  const auto end_ns = start_ns + static_cast<std::int64_t>(options.duration_s * 1e9);
  const auto stop = [&] {
    if (lines) {
      rig.advance_to(hal::monotonic_ns());
      lines->follow(rig);
    }
    return stop_asked != 0 || (options.duration_s > 0.0 && hal::monotonic_ns() >= end_ns);
  };
  constexpr double kWithoutLines_s = 5e-3;
  const double every_s = lines ? config.gpio.interval_s : kWithoutLines_s;
  server.run(stop, static_cast<int>(std::lround(1e3 * every_s)));
  const auto& counts = server.counts();
  std::cerr << "spoolwatch-rig: " << counts.requests << " requests of " << counts.clients
            << " clients, " << counts.refused << " refused\n";
  if (lines) std::cerr << "spoolwatch-rig: " << lines->edges() << " edges\n";
  return EXIT_SUCCESS;
}

int set(const std::string& address, const std::vector<std::string>& texts) {
  for (const std::string& text : texts) {
    const std::string wrong = hal::hil_rig::set_remotely(address, text);
    if (wrong.empty()) continue;
    std::cerr << "spoolwatch-rig: " << text << ": " << wrong << '\n';
    return config::schema::kUsageExitCode;
  }
  return EXIT_SUCCESS;
}

int run(int argc, char** argv) {
  CLI::App app("A simulated rig in real time that speaks Modbus TCP and RTU.", "spoolwatch-rig");
  app.set_version_flag("--version",
                       "spoolwatch-rig " + std::string(config::schema::product_version()));
  app.footer(hal::hil_rig::kRegisterMapText);
  RigOptions options;
  auto* file = app.add_option("--config", options.file, "the rig (TOML)");
  auto* listen = app.add_option("--listen", options.listen,
                                "address:port instead of [bus] listen; 0: any free port");
  auto* serial = app.add_option("--serial", options.serial, "instead of [bus] serial");
  app.add_option("--duration", options.duration_s, "seconds to run; default: until a signal")
      ->check(CLI::Range(1e-3, 1e9));
  app.add_option("--set", options.assignments, "table.key=value, overrides the file")
      ->allow_extra_args(false);
  bool reference = false;
  app.add_flag("--configuration-reference", reference)->group("");  // hidden: scripts/reference
  CLI::App* setting = app.add_subcommand("set", "changes a running rig: a fault, the e-stop");
  std::string address = "127.0.0.1:1502";
  std::vector<std::string> texts;
  setting->add_option("--address", address, "address of the rig");
  setting->add_option("parameter", texts, "name=value or name=xFACTOR (e_stop=0, mass_kg=x1.2)")
      ->required();
  try {
    app.parse(argc, argv);
    if (setting->count() == 0 && file->count() == 0 && !reference)
      throw CLI::RequiredError("--config");
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) {
      config::schema::require_known_options({argv + 1, argv + argc}, app);
    }
    return app.exit(e) == 0 ? EXIT_SUCCESS : config::schema::kUsageExitCode;
  }
  if (reference) {
    std::cout << "\n## Bench rig\n\nRead by `spoolwatch-rig --config FILE`.\n"
              << config::schema::print_reference(
                     [](config::schema::Visitor& v) { hal::hil_rig::RigConfig().visit(v); });
    return EXIT_SUCCESS;
  }
  if (setting->count() > 0) return set(address, texts);
  return serve(options, listen->count() > 0, serial->count() > 0);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "spoolwatch-rig: " << e.what() << '\n';
    return config::schema::exit_code_of(e);
  }
}
