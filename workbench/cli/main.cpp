// spoolwatch: the engineer's tool. One line per command; every error that prevents a start is
// caught here, once, and printed as one line.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>

#include "config/schema/exit_code.h"
#include "workbench/cli/command.h"

namespace {

constexpr workbench::cli::Command kCommands[] = {
    {"status", "what the running daemon does, and what forbids to arm it",
     workbench::cli::add_status},
    {"alarms", "the alarms of the running daemon, and what to do about them",
     workbench::cli::add_alarms},
    {"ack", "acknowledge an alarm, or all", workbench::cli::add_ack},
    {"shelve", "put an alarm aside for a time", workbench::cli::add_shelve},
    {"unshelve", "take it off the shelf", workbench::cli::add_unshelve},
    {"reload", "let the running daemon read its configuration again", workbench::cli::add_reload},
    {"commission", "find out how a rig is wired, and write its calibration file",
     workbench::cli::add_commission},
    {"arm", "let the running daemon be started", workbench::cli::add_arm},
    {"disarm", "null, from RUN or ARMED", workbench::cli::add_disarm},
    {"start", "run the reference signal from where the rod is; resume after a hold",
     workbench::cli::add_start},
    {"stop", "null at once, still ARMED", workbench::cli::add_stop},
    {"reset", "from LATCHED to DISARMED", workbench::cli::add_reset},
    {"hold", "freeze the reference where the rod is", workbench::cli::add_hold},
    {"reference", "another sine for the running daemon", workbench::cli::add_reference},
    {"reproduce", "the source's figures beside ours", workbench::cli::add_reproduce},
    {"simulate", "a record from a model file, in closed loop", workbench::cli::add_simulate},
    {"listen", "print alarms and estimates as they arrive", workbench::cli::add_listen},
    {"record", "a record from the running daemon", workbench::cli::add_record},
    {"estimate", "fit an ARX structure to a record", workbench::cli::add_estimate},
    {"select", "every model structure on a record, and which to take", workbench::cli::add_select},
    {"compare", "where a model fails against a record", workbench::cli::add_compare},
    {"fit", "a model's parameters estimated from records", workbench::cli::add_fit},
    {"diagnose", "which physical effect a model misses", workbench::cli::add_diagnose},
    {"isolate", "which physical parameter has changed, window by window",
     workbench::cli::add_isolate},
    {"calibrate", "learn alarm bands from a healthy record", workbench::cli::add_calibrate},
    {"scorecard", "what each method detects, how late, and how often it cries wolf",
     workbench::cli::add_scorecard},
    {"train", "teach the fault detection from records, healthy and faulty",
     workbench::cli::add_train},
    {"backtest", "which alarms new rules would have told on old logs",
     workbench::cli::add_backtest},
    {"promote", "a better model and its bands into the running daemon",
     workbench::cli::add_promote},
    {"replay", "from the evidence of an alarm to the same alarm", workbench::cli::add_replay},
    {"effects", "the library of physical effects", workbench::cli::add_effects},
    {"add", "a model file with an effect more", workbench::cli::add_add},
    {"export", "a log or record as CSV, MAT, MCAP or JSON", workbench::cli::add_export},
    {"bridge", "live values to PlotJuggler, JSON over UDP", workbench::cli::add_bridge},
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
    return asked_for_help ? 0 : config::schema::kUsageExitCode;
  }
  std::cout.flush();
  if (std::fflush(stdout) != 0 || !std::cout) {
    throw config::schema::RunError("standard output: cannot be written");
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spoolwatch: %s\n", error.what());
    return config::schema::exit_code_of(error);
  }
}
