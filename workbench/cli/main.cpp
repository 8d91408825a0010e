// spoolwatch: the engineer's tool. One line per command; every error that prevents a start is
// caught here, once, and printed as one line.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>

#include "config/schema/error.h"
#include "workbench/cli/command.h"

namespace {

constexpr Command kCommands[] = {
    {"status", "what the running daemon does, and what forbids to arm it", add_status},
    {"alarms", "the alarms of the running daemon, and what to do about them", add_alarms},
    {"ack", "acknowledge an alarm, or all", add_ack},
    {"shelve", "put an alarm aside for a time", add_shelve},
    {"unshelve", "take it off the shelf", add_unshelve},
    {"reload", "let the running daemon read its configuration again", add_reload},
    {"commission", "find out how a rig is wired, and write its calibration file", add_commission},
    {"arm", "let the running daemon be started", add_arm},
    {"disarm", "null, from RUN or ARMED", add_disarm},
    {"start", "run the reference signal from where the rod is; resume after a hold", add_start},
    {"stop", "null at once, still ARMED", add_stop},
    {"reset", "from LATCHED to DISARMED", add_reset},
    {"hold", "freeze the reference where the rod is", add_hold},
    {"reference", "another sine for the running daemon", add_reference},
    {"reproduce", "the source's figures beside ours", add_reproduce},
    {"simulate", "a record from a model file, in closed loop", add_simulate},
    {"listen", "print alarms and estimates as they arrive", add_listen},
    {"record", "a record from the running daemon", add_record},
    {"estimate", "fit an ARX structure to a record", add_estimate},
    {"select", "every model structure on a record, and which to take", add_select},
    {"compare", "where a model fails against a record", add_compare},
    {"fit", "a model's parameters estimated from records", add_fit},
    {"diagnose", "which physical effect a model misses", add_diagnose},
    {"isolate", "which physical parameter has changed, window by window", add_isolate},
    {"calibrate", "learn alarm bands from a healthy record", add_calibrate},
    {"scorecard", "what each method detects, how late, and how often it cries wolf", add_scorecard},
    {"train", "teach the fault detection from records, healthy and faulty", add_train},
    {"backtest", "which alarms new rules would have told on old logs", add_backtest},
    {"promote", "a better model and its bands into the running daemon", add_promote},
    {"replay", "from the evidence of an alarm to the same alarm", add_replay},
    {"effects", "the library of physical effects", add_effects},
    {"add", "a model file with an effect more", add_add},
    {"export", "a log or record as CSV, MAT, MCAP or JSON", add_export},
    {"bridge", "live values to PlotJuggler, JSON over UDP", add_bridge},
};

int run(int argc, char** argv) {
  int exit_code = 0;
  CLI::App app{"Spoolwatch: watch a servo-hydraulic test stand, and find what its model misses"};
  app.require_subcommand(1);
  for (const auto& command : kCommands) {
    command.setup(*app.add_subcommand(command.name, command.what), exit_code);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    app.exit(error);
    return asked_for_help ? 0 : static_cast<int>(config::schema::ExitCode::usage);
  }
  std::cout.flush();
  if (std::fflush(stdout) != 0 || !std::cout) {
    throw config::schema::Error(config::schema::ExitCode::failed,
                                "standard output: cannot be written");
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const config::schema::Error& error) {
    std::fprintf(stderr, "spoolwatch: %s\n", error.what());
    return error.exit_code();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spoolwatch: %s\n", error.what());
    return static_cast<int>(config::schema::ExitCode::failed);
  }
}
