// spoolwatch status | arm | disarm | start | stop | reset | hold | reference: the running daemon,
// asked and ordered through its control socket.
#include <CLI/CLI.hpp>
#include <fstream>
#include <iostream>
#include <memory>

#include "config/schema/error.h"
#include "daemon/control/protocol.h"
#include "workbench/command.h"
#include "workbench/control/client.h"
#include "workbench/control/status_text.h"

namespace workbench {
namespace {

using config::schema::Error;
using config::schema::ExitCode;
using Json = nlohmann::ordered_json;
namespace control = monitor::control;

struct Options {
  std::string socket = control::kDefaultSocket;
  std::string json;
  double centre_m = 0.0;
  double amplitude_m = 0.0;
  double frequency_Hz = 0.0;
};

void write_json(const Json& answer, const std::string& file) {
  const std::string text = answer.dump(2) + '\n';
  if (file == "-") {
    std::cout << text;
    return;
  }
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw Error(ExitCode::failed, file + ": cannot be written");
}

int order(const Json& request, const Options& options) {
  const Json answer = ask_daemon(options.socket, request);
  if (!options.json.empty()) write_json(answer, options.json);
  if (!answer.at(control::key::kOk).get<bool>()) {
    const auto reason = answer.find(control::key::kReason);
    throw Error(
        ExitCode::failed,
        "refused: " +
            (reason != answer.end() && reason->is_string() ? reason->get<std::string>()
                                                           : std::string("no reason given")) +
            " (the state is " + answer.at(control::key::kState).get<std::string>() + ")");
  }
  if (options.json == "-") return 0;
  if (request.at(control::key::kCommand) == control::kStatus) {
    print_status(answer, std::cout);
  } else {
    std::cout << answer.at(control::key::kState).get<std::string>() << '\n';
  }
  return 0;
}

std::shared_ptr<Options> add_common(CLI::App& command) {
  auto options = std::make_shared<Options>();
  command.add_option("--socket", options->socket, "control socket of the daemon")
      ->capture_default_str();
  command.add_option("--json", options->json, "write the answer there; - for standard output");
  return options;
}

void add_word(CLI::App& command, int& exit_code, const char* word) {
  const auto options = add_common(command);
  command.callback([options, word, &exit_code] {
    exit_code = order({{control::key::kCommand, word}}, *options);
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
  const auto options = add_common(command);
  command.add_option("--centre", options->centre_m, "middle of the motion, m")->required();
  command.add_option("--amplitude", options->amplitude_m, "m")->capture_default_str();
  command.add_option("--frequency", options->frequency_Hz, "Hz")->capture_default_str();
  command.callback([options, &exit_code] {
    exit_code = order({{control::key::kCommand, control::kReference},
                       {control::key::kCentre, options->centre_m},
                       {control::key::kAmplitude, options->amplitude_m},
                       {control::key::kFrequency, options->frequency_Hz}},
                      *options);
  });
}

}  // namespace workbench
