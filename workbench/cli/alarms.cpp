// spoolwatch alarms | ack | shelve | unshelve: the alarms of the running daemon.
#include <chrono>
#include <iostream>
#include <map>
#include <memory>

#include "config/schema/error.h"
#include "daemon/control/protocol.h"
#include "workbench/cli/command.h"
#include "workbench/cli/order_options.h"
#include "workbench/control/alarm_statistics.h"
#include "workbench/control/answer_text.h"
#include "workbench/present/json.h"

namespace workbench::cli {
namespace {

using config::schema::UsageError;
using nlohmann::ordered_json;
namespace protocol = monitor::control;

struct AlarmOptions {
  control::OrderOptions common;
  std::string alarm;
  bool all = false;
  double time_s = 0.0;
  bool statistics = false;
  std::string history;
};

void print_statistics(const AlarmOptions& options) {
  std::string folder = options.history;
  std::int64_t now_us = 0;
  if (folder.empty()) {
    const ordered_json status =
        control::ask_daemon(options.common.socket, {{protocol::key::kCommand, protocol::kStatus}});
    folder = status.value("alarm_folder", "");
    if (folder.empty()) {
      throw config::schema::RunError("the daemon keeps no history: [alarms] folder is empty");
    }
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    now_us = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
  }
  const control::AlarmStatistics found =
      control::alarm_statistics(control::read_history(folder), now_us);
  if (!present::write_json(control::to_json(found), options.common.json)) {
    control::print_statistics(found, std::cout);
  }
}

void act(const char* word, const AlarmOptions& options, bool with_time) {
  ordered_json request = {{protocol::key::kCommand, word}};
  if (!options.alarm.empty()) request[protocol::key::kAlarm] = options.alarm;
  if (with_time) request[protocol::key::kTime] = options.time_s;
  const ordered_json answer = control::give_order(request, options.common);
  if (options.common.json == "-") return;
  const auto done = answer.find(protocol::key::kDone);
  if (done == answer.end() || !done->is_array() || done->empty()) {
    std::cout << "nothing to do\n";
    return;
  }
  for (const ordered_json& alarm : *done) std::cout << alarm.get<std::string>() << '\n';
}

}  // namespace

void add_alarms(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<AlarmOptions>();
  add_order_options(command, options->common);
  command.add_flag("--all", options->all, "include normal alarms");
  CLI::Option* const statistics = command.add_flag(
      "--statistics", options->statistics,
      "figures of ISA-18.2 from the stored history: alarms per hour, bursts, standing, chattering");
  command
      .add_option("--history", options->history,
                  "folder of the history; without: that of the running daemon, [alarms] folder")
      ->needs(statistics);
  command.callback([options] {
    if (options->statistics) return print_statistics(*options);
    const ordered_json answer =
        control::give_order({{protocol::key::kCommand, protocol::kAlarms}}, options->common);
    if (options->common.json != "-") control::print_alarms(answer, options->all, std::cout);
  });
}

void add_ack(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<AlarmOptions>();
  add_order_options(command, options->common);
  CLI::Option* alarm =
      command.add_option("alarm", options->alarm, "SOURCE.NAME, as `alarms` lists it");
  command.add_flag("--all", options->all, "all unacknowledged alarms")->excludes(alarm);
  command.callback([options] {
    if (options->alarm.empty() && !options->all) {
      throw UsageError("ack: no alarm; allowed: SOURCE.NAME, or --all");
    }
    act(protocol::kAcknowledge, *options, false);
  });
}

void add_shelve(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<AlarmOptions>();
  add_order_options(command, options->common);
  command.add_option("alarm", options->alarm, "SOURCE.NAME, as `alarms` lists it")->required();
  const std::map<std::string, double> units = {{"s", 1.0}, {"min", 60.0}, {"h", 3600.0}};
  command.add_option("--for", options->time_s, "duration: 90s, 10min, 2h")
      ->required()
      ->transform(CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::UNIT_REQUIRED));
  command.callback([options] { act(protocol::kShelve, *options, true); });
}

void add_unshelve(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<AlarmOptions>();
  add_order_options(command, options->common);
  command.add_option("alarm", options->alarm, "SOURCE.NAME, as `alarms` lists it")->required();
  command.callback([options] { act(protocol::kUnshelve, *options, false); });
}

}  // namespace workbench::cli
