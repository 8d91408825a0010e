#include "workbench/control/order.h"

#include <fstream>
#include <iostream>

#include "config/schema/error.h"
#include "workbench/control/client.h"

namespace workbench::control {
namespace {

using config::schema::RunError;
using Json = nlohmann::ordered_json;
namespace protocol = monitor::control;

void write_json(const Json& answer, const std::string& file) {
  const std::string text = answer.dump(2) + '\n';
  if (file == "-") {
    std::cout << text;
    return;
  }
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out) throw RunError(file + ": cannot be written");
}

}  // namespace

Json give_order(const Json& request, const OrderOptions& options) {
  Json answer = ask_daemon(options.socket, request);
  if (!options.json.empty()) write_json(answer, options.json);
  if (answer.at(protocol::key::kOk).get<bool>()) return answer;
  const auto reason = answer.find(protocol::key::kReason);
  throw RunError("refused: " +
                 (reason != answer.end() && reason->is_string() ? reason->get<std::string>()
                                                                : std::string("no reason given")) +
                 " (the state is " + answer.at(protocol::key::kState).get<std::string>() + ")");
}

}  // namespace workbench::control
