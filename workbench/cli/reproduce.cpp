// `spoolwatch reproduce`: the thesis's figures beside ours.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <thread>

#include "config/schema/error.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/row.h"

namespace workbench::cli {
namespace {

using config::schema::RunError;

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
    std::ofstream file;
    if (!arguments->json.empty() && arguments->json != "-") {
      file.open(arguments->json);
      if (!file) throw RunError(arguments->json + ": cannot be written");
    }
    const auto sections = reproduce::run_all(reproduce::experiments(),
                                             std::max(1U, std::thread::hardware_concurrency()));
    if (arguments->json == "-") {
      reproduce::print_json(std::cout, sections);
    } else {
      reproduce::print_table(std::cout, sections);
      if (file.is_open()) reproduce::print_json(file, sections);
    }
    if (file.is_open() && !file.flush()) throw RunError(arguments->json + ": cannot be written");
    const bool all = std::none_of(sections.begin(), sections.end(), [](const auto& section) {
      return std::any_of(section.rows.begin(), section.rows.end(), missed);
    });
    if (arguments->strict && !all) exit_code = EXIT_FAILURE;
  });
}

}  // namespace workbench::cli
