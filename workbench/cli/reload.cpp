// spoolwatch reload: the daemon reads its configuration again.
#include <iostream>
#include <memory>

#include "daemon/control/protocol.h"
#include "workbench/cli/command.h"
#include "workbench/cli/order_options.h"

namespace workbench::cli {
namespace {

using nlohmann::ordered_json;
namespace protocol = monitor::control;

void print(const ordered_json& answer, const char* key, const char* what) {
  const auto list = answer.find(key);
  if (list == answer.end() || !list->is_array()) return;
  for (const ordered_json& entry : *list) {
    if (entry.is_string()) std::cout << what << entry.get<std::string>() << '\n';
  }
}

void reload(const control::OrderOptions& options) {
  const ordered_json answer =
      control::give_order({{protocol::key::kCommand, protocol::kReload}}, options);
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

}  // namespace workbench::cli
