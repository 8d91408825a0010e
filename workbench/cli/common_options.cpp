#include "workbench/cli/common_options.h"

#include <CLI/CLI.hpp>

#include "config/record/reading.h"
#include "workbench/cli/number_check.h"
#include "workbench/present/shell_command.h"

namespace workbench::cli {
namespace {

constexpr int kMostThreads = 256;

}  // namespace

CLI::Option* add_model(CLI::App& command, std::string& file) {
  return command.add_option("MODEL", file, "a model file (TOML)")->required();
}

CLI::Option* add_record(CLI::App& command, std::string& file) {
  return command.add_option("RECORD", file, "CSV or MAT (t_s,u_V,y_m, or --map), or LCM log")
      ->required();
}

CLI::Option* add_records(CLI::App& command, std::vector<std::string>& files) {
  return command
      .add_option(
          "RECORD", files,
          "CSV or MAT (t_s,u_V,y_m, or --map), or LCM log; several are fitted together, each "
          "at its own rate")
      ->required();
}

void add_reading(CLI::App& command, config::record::ReadOptions& reading) {
  command
      .add_option("--map", reading.map,
                  "t=COLUMN,u=COLUMN[UNIT],y=-COLUMN*2.5[mm],NAME=...: the record's columns by "
                  "header or number; t=1000Hz without times; or a file with such pairs")
      ->check([](const std::string& text) {
        (void)config::record::parse_map(text);
        return std::string();
      });
  command
      .add_flag("--resample{auto}", reading.resample,
                "interpolate to an even rate; --resample=HZ states which")
      ->check([](const std::string& text) {
        (void)config::record::parse_resample(text);
        return std::string();
      });
  command.add_flag("--flip", reading.flip_command, "turn the sign of the command");
  command
      .add_option("--advance", reading.advance_command_s,
                  "s: advance the command by this time; below 0 it is delayed")
      ->check(finite_number());
}

CLI::Option* add_holdouts(CLI::App& command, std::vector<std::string>& files) {
  return command.add_option("--holdout", files, "validation record, not fitted")
      ->allow_extra_args(false);
}

CLI::Option* add_json(CLI::App& command, std::string& file) {
  return command.add_option("--json", file, "file for JSON, - for standard output");
}

CLI::Option* add_report(CLI::App& command, std::string& file) {
  return command.add_option("--report", file, "file for a report with plots (HTML)");
}

CLI::Option* add_set(CLI::App& command, std::vector<std::string>& assignments) {
  return command
      .add_option("--set", assignments, "table.key=value of the model file, for this run")
      ->allow_extra_args(false);
}

CLI::Option* add_observer(CLI::App& command, double& observer_per_s) {
  return command
      .add_option("--observer", observer_per_s,
                  "1/s: gain that corrects the simulated position towards the measured one")
      ->capture_default_str();
}

CLI::Option* add_threads(CLI::App& command, unsigned& threads) {
  return command.add_option("--threads", threads, "number of threads; default: one per processor")
      ->check(number_within(1, kMostThreads));
}

CLI::Option* add_quiet(CLI::App& command, bool& quiet) {
  return command.add_flag("--quiet", quiet, "no progress on standard error");
}

std::string command_line(const std::string& name, const CLI::App& command) {
  std::vector<std::string> words{"spoolwatch", name};
  for (const bool positional : {true, false}) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->count() == 0 || option->get_positional() != positional) continue;
      const bool flag = option->get_items_expected_max() == 0;
      for (const std::string& value : option->results()) {
        if (!positional) words.push_back(option->get_name());
        if (!flag) words.push_back(value);
      }
    }
  }
  return present::shell_command(words);
}

void add_interrupt_footer(CLI::App& command) {
  command.footer(
      "Ctrl-C ends it early: the best so far is printed and written, marked as interrupted, and "
      "the exit code is 130; a second Ctrl-C ends the program at once.");
}

}  // namespace workbench::cli
