// `spoolwatch reproduce`: the thesis's figures beside ours.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <thread>

#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/files/file_check.h"
#include "workbench/present/json.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/row.h"

namespace workbench::cli {
namespace {

struct ReproduceArguments {
  std::string json;
  bool strict = false;
};

bool missed(const reproduce::ReproducedRow& row) {
  return row.expected && row.agrees == reproduce::Agreement::no;
}

}  // namespace

void add_reproduce(CLI::App& command, int& exit_code) {
  auto arguments = std::make_shared<ReproduceArguments>();
  add_json(command, arguments->json);
  command.add_flag("--strict", arguments->strict,
                   "exit 1 when a figure that is meant to agree does not");
  command.callback([arguments, &exit_code] {
    files::check_outputs({{"--json", arguments->json}}, {});
    const auto sections = reproduce::run_all(reproduce::experiments(),
                                             std::max(1U, std::thread::hardware_concurrency()));
    if (arguments->json != "-") reproduce::print_table(std::cout, sections);
    if (!arguments->json.empty()) {
      std::ostringstream json;
      reproduce::print_json(json, sections);
      present::write_json(json.str(), arguments->json);
    }
    const bool all = std::none_of(sections.begin(), sections.end(), [](const auto& section) {
      return std::any_of(section.rows.begin(), section.rows.end(), missed);
    });
    if (arguments->strict && !all) exit_code = EXIT_FAILURE;
  });
}

}  // namespace workbench::cli
