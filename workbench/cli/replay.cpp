// spoolwatch replay FOLDER: from the evidence of an alarm to the same alarm, bit for bit.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/present/json.h"
#include "workbench/replay/replayer.h"

namespace workbench::cli {
namespace {

using nlohmann::ordered_json;
using replay::Pack;
using replay::ReplayOutcome;

struct ReplayOptions {
  std::string folder;
  std::string json;
};

std::string hex(double value) {
  return fmt::format("{:016x}", std::bit_cast<std::uint64_t>(value));
}

std::string seconds(const Pack& pack, std::int64_t tick) {
  return fmt::format("{:.3f} s", static_cast<double>(tick) * pack.sample_time_s);
}

void print(const Pack& pack, const ReplayOutcome& outcome, std::ostream& out) {
  out << "evidence of " << pack.source << '.' << pack.name << " on rig " << pack.rig_id << ", "
      << pack.utc << '\n'
      << "  " << outcome.samples << " samples from " << seconds(pack, pack.first_tick) << "; "
      << outcome.estimates_same << " of " << outcome.estimates << " estimates and "
      << outcome.alarms_same << " of " << outcome.alarms << " changes of alarms the same\n";
  if (outcome.found) {
    out << "  " << to_string(outcome.alarm.severity) << " at sample " << outcome.alarm.tick << ", "
        << seconds(pack, outcome.alarm.tick) << ": ";
    if (std::isfinite(outcome.alarm.value)) {
      out << fmt::format("{} = {:.9g}, bits {}\n", outcome.alarm.quantity, outcome.alarm.value,
                         hex(outcome.alarm.value));
    } else {
      out << outcome.alarm.reason << '\n';
    }
    if (!outcome.derived) {
      out << "  this alarm does not come from the fault detection: shown as it was recorded\n";
    }
  }
  for (const std::string& difference : outcome.differences) out << "  " << difference << '\n';
  if (outcome.same()) {
    out << (outcome.derived ? "the same alarm" : "the same fault detection") << ", bit for bit\n";
  } else {
    out << (outcome.found ? "not the same\n" : "the alarm does not come again\n");
  }
}

ordered_json as_json(const Pack& pack, const ReplayOutcome& outcome) {
  ordered_json alarm = nullptr;
  if (outcome.found) {
    alarm = {{"source", pack.source},
             {"name", pack.name},
             {"severity", to_string(outcome.alarm.severity)},
             {"tick", outcome.alarm.tick},
             {"value_bits", hex(outcome.alarm.value)},
             {"first_up", outcome.alarm.first_up},
             {"derived", outcome.derived}};
  }
  return {{"same", outcome.same()},
          {"alarm", alarm},
          {"samples", outcome.samples},
          {"estimates", outcome.estimates},
          {"estimates_same", outcome.estimates_same},
          {"alarms", outcome.alarms},
          {"alarms_same", outcome.alarms_same},
          {"differences", outcome.differences}};
}

int run(const ReplayOptions& options) {
  const Pack pack = replay::read_pack(options.folder);
  const ReplayOutcome outcome = replay::replay(pack);
  if (!present::write_json(as_json(pack, outcome).dump(2) + '\n', options.json)) {
    print(pack, outcome, std::cout);
  }
  return outcome.same() ? 0 : EXIT_FAILURE;
}

}  // namespace

void add_replay(CLI::App& command, int& exit_code) {
  const auto options = std::make_shared<ReplayOptions>();
  command.add_option("folder", options->folder, "evidence of an alarm, as spoolwatchd wrote it")
      ->required();
  add_json(command, options->json);
  command.footer("Exit code 0: the same alarm came again, bit for bit; 1: it did not.");
  command.callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace workbench::cli
