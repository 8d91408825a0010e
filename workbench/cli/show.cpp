// spoolwatch show: every parameter of a model, where it comes from, and what follows.
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/model/sheet.h"
#include "workbench/present/json.h"

namespace workbench::cli {

void add_show(CLI::App& command, int&) {
  struct ShowOptions {
    std::string model, json;
    std::vector<std::string> assignments;
  };
  auto options = std::make_shared<ShowOptions>();
  add_model(command, options->model);
  add_set(command, options->assignments);
  add_json(command, options->json);
  command.callback([options] {
    const model::Sheet sheet = model::sheet_of(options->model, options->assignments);
    if (!present::write_json(to_json(sheet), options->json)) std::cout << to_text(sheet);
  });
}

}  // namespace workbench::cli
