// spoolwatch select: every structure of the thesis on one record, and which to take.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/interrupt.h"
#include "workbench/cli/number_check.h"
#include "workbench/files/file_check.h"
#include "workbench/present/json.h"
#include "workbench/select/outcome.h"

namespace workbench::cli {
namespace {

using select::SelectOutcome;
using select::SelectRequest;

constexpr const char* kWipe = "\r\x1b[K";

int run(const SelectRequest& request) {
  files::check_outputs({{.option = "--json", .file = request.json}},
                       {.model = request.record, .records = {}});
  const Interrupt interrupt;
  const bool renewed = isatty(STDERR_FILENO) == 1;
  const auto show = [&](const select::SelectProgress& progress) {
    if (request.quiet) return;
    std::cerr << (renewed ? kWipe : "") << progress.done << " of " << progress.of << ": "
              << progress.doing << (renewed ? "" : "\n") << std::flush;
  };
  const SelectOutcome outcome =
      compare_structures(request, show, [] { return Interrupt::requested(); });
  if (renewed && !request.quiet) std::cerr << kWipe << std::flush;
  if (!present::write_json(to_json(outcome), request.json)) std::cout << to_text(outcome);
  return Interrupt::exit_code();
}

}  // namespace

void add_select(CLI::App& command, int& exit_code) {
  auto request = std::make_shared<SelectRequest>();
  add_record(command, request->record);
  add_reading(command, request->reading);
  command
      .add_option("--structures", request->structures,
                  "name[,name...]: arxNMK, armaxNMCK, oeMFK, bjMCDFK, ssN, n4sidN, narxNMK/H; "
                  "without it some of each kind")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      .add_option("--delay", request->delay,
                  "samples from u to y, of the usual structures; without it found in the record")
      ->check(number_within(0, 50));
  command.add_option("--period", request->period_s, "s: period of the motion, or another unit")
      ->check(positive_number())
      ->capture_default_str();
  command
      .add_option("--fit-to", request->fit_share,
                  "share of the record that is fitted; the rest scores")
      ->check(number_within(0.1, 0.9))
      ->capture_default_str();
  command.add_flag("!--no-constant", request->constant, "estimate no constant term");
  command.add_flag("!--keep-offset", request->de_mean, "take no mean off y");
  add_threads(command, request->threads);
  add_json(command, request->json);
  add_quiet(command, request->quiet);
  command.callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace workbench::cli
