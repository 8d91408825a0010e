// spoolwatch commission: the spoolwatchd next to this program commissions the rig, for it has the
// devices; its words, its questions and its exit code pass through.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstring>
#include <memory>

#include "config/schema/error.h"
#include "workbench/cli/command.h"
#include "workbench/stand/daemon_check.h"

namespace workbench::cli {
namespace {

using config::schema::RunError;

struct CommissionCommandOptions {
  std::string config;
  std::string out;
};

/// Replaces this process, so that signals reach it. Throws Error when it cannot.
[[noreturn]] void become_daemon(const CommissionCommandOptions& options,
                                const std::vector<std::string>& more) {
  std::string program = stand::daemon_program().string();
  std::vector<std::string> words{"--config", options.config, "--commission", options.out};
  words.insert(words.end(), more.begin(), more.end());
  std::vector<char*> argv{program.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  throw RunError(program + ": " + std::strerror(errno));
}

}  // namespace

void add_commission(CLI::App& command, int& /*exit_code*/) {
  const auto options = std::make_shared<CommissionCommandOptions>();
  command.add_option("--config", options->config, "the daemon's configuration")->required();
  command.add_option("-o,--out", options->out, "calibration file to be written")->required();
  command.allow_extras();
  command.footer(
      "All further options go to spoolwatchd (its --help explains them): --yes, --set KEY=VALUE,\n"
      "--max-travel-mm, --max-speed-mmps, --authority, --pulse, --home, --home-travel-mm,\n"
      "--stroke-mm, --clock.");
  command.callback([options, &command] { become_daemon(*options, command.remaining()); });
}

}  // namespace workbench::cli
