// spoolwatch status | arm | disarm | start | stop | reset | hold | reference: the running daemon,
// asked and ordered through its control socket.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "daemon/control/protocol.h"
#include "workbench/cli/command.h"
#include "workbench/cli/order_options.h"
#include "workbench/control/answer_text.h"

namespace workbench::cli {
namespace {

using nlohmann::ordered_json;
namespace protocol = monitor::control;

struct ReferenceOptions {
  control::OrderOptions common;
  double centre_m = 0.0;
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
};

int order(const ordered_json& request, const control::OrderOptions& options) {
  const ordered_json answer = control::give_order(request, options);
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

}  // namespace workbench::cli
