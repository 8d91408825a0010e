// spoolwatch status | arm | disarm | start | stop | reset | hold | reference | reload | alarms |
// ack | shelve | unshelve: the running daemon, asked and ordered through its control socket.
#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <memory>

#include "config/schema/error.h"
#include "daemon/control/protocol.h"
#include "workbench/cli/command.h"
#include "workbench/control/order.h"

namespace workbench::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace protocol = monitor::control;

/// --socket and --json, which every command shares; `options` outlives the parsing.
void add_order_options(CLI::App& command, control::OrderOptions& options) {
  command.add_option("--socket", options.socket, "control socket of the daemon")
      ->capture_default_str();
  command.add_option("--json", options.json, "write the answer there; - for standard output");
}

struct ReferenceOptions {
  control::OrderOptions common;
  double centre_m = 0.0;
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
};

int order(const Json& request, const control::OrderOptions& options) {
  const Json answer = control::give_order(request, options);
  if (options.json == "-") return 0;
  if (request.at(protocol::key::kCommand) == protocol::kStatus) {
    control::print_status(answer, std::cout);
  } else {
    std::cout << answer.at(protocol::key::kState).get<std::string>() << '\n';
  }
  return 0;
}

void add_word(CLI::App& command, int& exit_code, const char* word) {
  const auto options = std::make_shared<control::OrderOptions>();
  add_order_options(command, *options);
  command.callback([options, word, &exit_code] {
    exit_code = order({{protocol::key::kCommand, word}}, *options);
  });
}

}  // namespace

void add_status(CLI::App& command, int& exit_code) { add_word(command, exit_code, "status"); }
void add_arm(CLI::App& command, int& exit_code) { add_word(command, exit_code, "arm"); }
void add_disarm(CLI::App& command, int& exit_code) { add_word(command, exit_code, "disarm"); }
void add_start(CLI::App& command, int& exit_code) { add_word(command, exit_code, "start"); }
void add_stop(CLI::App& command, int& exit_code) { add_word(command, exit_code, "stop"); }
void add_reset(CLI::App& command, int& exit_code) { add_word(command, exit_code, "reset"); }
void add_hold(CLI::App& command, int& exit_code) { add_word(command, exit_code, "hold"); }

void add_reference(CLI::App& command, int& exit_code) {
  const auto options = std::make_shared<ReferenceOptions>();
  add_order_options(command, options->common);
  command.add_option("--centre", options->centre_m, "middle of the motion, m")->required();
  command.add_option("--amplitude", options->amplitude_m, "m")->capture_default_str();
  command.add_option("--frequency", options->frequency_Hz, "Hz")->capture_default_str();
  command.callback([options, &exit_code] {
    exit_code = order({{protocol::key::kCommand, protocol::kReference},
                       {protocol::key::kCentre, options->centre_m},
                       {protocol::key::kAmplitude, options->amplitude_m},
                       {protocol::key::kFrequency, options->frequency_Hz}},
                      options->common);
  });
}

namespace {

using Json = nlohmann::ordered_json;

void print(const Json& answer, const char* key, const char* what) {
  const auto list = answer.find(key);
  if (list == answer.end() || !list->is_array()) return;
  for (const Json& entry : *list) {
    if (entry.is_string()) std::cout << what << entry.get<std::string>() << '\n';
  }
}

void reload(const control::OrderOptions& options) {
  const Json answer = control::give_order({{protocol::key::kCommand, protocol::kReload}}, options);
  if (options.json == "-") return;
  const auto changed = answer.find("changed");
  if (changed == answer.end() || changed->empty()) std::cout << "no key has changed\n";
  print(answer, "changed", "changed: ");
  print(answer, "warm", "estimator continues: ");
  print(answer, "cold", "estimator warms up: ");
  print(answer, "ended", "alarm ended: ");
}

}  // namespace

void add_reload(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<control::OrderOptions>();
  add_order_options(command, *options);
  command.callback([options] { reload(*options); });
}

namespace {

using config::schema::UsageError;
using Json = nlohmann::ordered_json;

struct AlarmOptions {
  control::OrderOptions common;
  std::string alarm;
  bool all = false;
  double time_s = 0.0;
};

void act(const char* word, const AlarmOptions& options, bool with_time) {
  Json request = {{protocol::key::kCommand, word}};
  if (!options.alarm.empty()) request[protocol::key::kAlarm] = options.alarm;
  if (with_time) request[protocol::key::kTime] = options.time_s;
  const Json answer = control::give_order(request, options.common);
  if (options.common.json == "-") return;
  const auto done = answer.find(protocol::key::kDone);
  if (done == answer.end() || !done->is_array() || done->empty()) {
    std::cout << "nothing to do\n";
    return;
  }
  for (const Json& alarm : *done) std::cout << alarm.get<std::string>() << '\n';
}

}  // namespace

void add_alarms(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<AlarmOptions>();
  add_order_options(command, options->common);
  command.add_flag("--all", options->all, "include normal alarms");
  command.callback([options] {
    const Json answer =
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
