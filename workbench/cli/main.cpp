// spoolwatch: the engineer's tool. Every error that prevents a start is caught here, once, and
// printed as one line.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include "config/record/hdf5/hdf5_variables.h"
#include "config/record/record.h"
#include "config/schema/error.h"
#include "config/schema/product_version.h"
#include "config/schema/spelling.h"
#include "workbench/cli/command.h"
#include "workbench/cli/file_places.h"

namespace {

/// Headings of --help.
namespace group {
constexpr char model[] = "Model";
constexpr char data[] = "Data";
constexpr char detection[] = "Detection";
constexpr char stand[] = "Running stand";
constexpr char exchange[] = "Exchange";
}  // namespace group

struct Command {
  const char* name;
  const char* group;
  const char* what;
  workbench::cli::Setup setup;
};

constexpr Command kCommands[] = {
#define COMMAND(heading, name, what) {#name, group::heading, what, workbench::cli::add_##name},
#include "workbench/cli/commands.def"
#undef COMMAND
};

/// Throws UsageError for a first word that is no command; options and nothing are left to
/// CLI11.
void require_command(const CLI::App& app, const std::string& word) {
  if (word.empty() || word.front() == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
    for (const std::string& alias : command->get_aliases()) names.push_back(alias);
  }
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string near = config::schema::nearest(word, names);
  throw config::schema::UsageError(
      "command " + word + " is unknown" +
      (near.empty() ? "; spoolwatch --help lists all" : ", did you mean " + near + "?"));
}

int run(int argc, char** argv) {
  config::record::set_hdf5_reader(config::record::hdf5::read_hdf5_variables);
  int exit_code = 0;
  CLI::App app{"Spoolwatch: watch a servo-hydraulic test stand, and find what its model misses",
               "spoolwatch"};
  for (const Command& command : kCommands) {
    CLI::App* const added = app.add_subcommand(command.name, command.what);
    added->group(command.group);
    command.setup(*added, exit_code);
    added->parse_complete_callback([added] { workbench::cli::check_places(*added); });
  }
  app.require_subcommand(1);
  app.set_version_flag("--version", "spoolwatch " + std::string(config::schema::product_version()));
  app.add_flag_callback("--configuration-reference",
                        [] {  // hidden: scripts/reference
                          std::cout << workbench::cli::configuration_reference();
                          throw CLI::Success();
                        })
      ->group("");
  app.footer("spoolwatch help COMMAND explains one command.");
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front() == "help") {  // `help fit` is `fit --help`
    words.erase(words.begin());
    words.resize(std::min<std::size_t>(words.size(), 1));
    words.emplace_back("--help");
  }
  // `model show` is `show`: commands that have a model file as their subject
  if (words.size() > 1 && words.front() == "model") words.erase(words.begin());
  if (words.empty()) throw config::schema::UsageError("no command; spoolwatch --help lists all");
  require_command(app, words.front());
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as CLI11 takes them
  } catch (const CLI::ParseError& error) {
    const bool asked_for_help = error.get_exit_code() == 0;
    if (!asked_for_help) {
      const bool is_option = words.front().starts_with('-');
      const CLI::App& command = is_option ? app : *app.get_subcommand(words.front());
      config::schema::require_known_options(words, command, is_option ? "" : words.front() + ": ");
      workbench::cli::check_places(command);
    }
    if (asked_for_help) {
      app.exit(error);
      return 0;
    }
    const bool is_command = !words.front().starts_with('-');
    throw config::schema::UsageError(
        (is_command ? words.front() + ": " : "") + std::string(error.what()) + "; spoolwatch " +
        (is_command ? "help " + words.front() : "--help") + " lists what it takes");
  }
  std::cout.flush();
  if (std::fflush(stdout) != 0 || !std::cout) {
    throw config::schema::RunError("standard output: cannot be written");
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "spoolwatch: not enough memory for this input\n");
    return EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spoolwatch: %s\n", error.what());
    return config::schema::exit_code_of(error);
  }
}
