// spoolwatch fit: a model's parameters estimated from records.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "config/record/whole_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/interrupt.h"
#include "workbench/cli/number_check.h"
#include "workbench/cli/selection_options.h"
#include "workbench/files/write_all.h"
#include "workbench/fit/fit_report.h"
#include "workbench/present/json.h"
#include "workbench/present/printed_axis.h"

namespace workbench::cli {
namespace {

using fit::FitRequest;

constexpr int kMostStarts = 1000;

void write(const fit::FitReport& outcome, const FitRequest& request) {
  files::write_all({[&] {
                      if (!present::write_json(to_json(outcome), request.json))
                        std::cout << to_text(outcome);
                    },
                    [&] {
                      if (!request.output.empty())
                        config::record::write_whole(request.output, to_model(outcome));
                    },
                    [&] {
                      if (!request.report.empty()) write_report(to_report(outcome), request.report);
                    }});
}

int run(const FitRequest& request) {
  fit::PreparedFit prepared = prepare(request);
  const present::PrintedAxis axis(present::motion_of(prepared.problem.model));
  const Interrupt interrupt;
  prepared.options.cancel = Interrupt::requested;
  const bool shown = !request.quiet && isatty(STDERR_FILENO) == 1;
  if (shown) {
    prepared.options.progress = [](const estimator::greybox::EstimationProgress& progress) {
      std::cerr << "\r\x1b[K" << fit::progress_words(progress) << std::flush;
    };
  }
  const fit::FitReport outcome = fit::run(prepared);
  if (shown) std::cerr << "\r\x1b[K" << std::flush;
  write(outcome, request);
  return Interrupt::exit_code();
}

void declare_choice(CLI::App& command, FitRequest& request) {
  add_parameter_selection(command, request.selection);
  add_ignored(command, request.ignored);
  command
      .add_option("--weight", request.weights, "weight of each record's squared errors, in order")
      ->allow_extra_args(false)
      ->check(number_within(0.0, 1e6));
}

}  // namespace

void add_fit(CLI::App& command, int& exit_code) {
  auto request = std::make_shared<FitRequest>();
  add_model(command, request->model);
  add_records(command, request->records);
  add_reading(command, request->reading);
  command.add_option("-o,--output", request->output, "the model file to write");
  declare_choice(command, *request);
  CLI::Option* const holdout = add_holdouts(command, request->holdouts);
  add_split(command, request->fit, true)->excludes(holdout);
  command.add_option("--starts", request->starts, "number of starting points")
      ->check(number_within(1, kMostStarts))
      ->capture_default_str();
  command
      .add_option("--profile", request->profiles,
                  "walk the likelihood of: a parameter's name, doubtful (default), none")
      ->allow_extra_args(false);
  add_observer(command, request->observer_per_s)->check(number_within(0.0, 1e4));
  add_threads(command, request->threads);
  add_set(command, request->assignments);
  add_json(command, request->json);
  add_report(command, request->report);
  add_quiet(command, request->quiet);
  add_interrupt_footer(command);
  command.callback([request, &exit_code, &command] {
    request->command = command_line("fit", command);
    exit_code = run(*request);
  });
}

}  // namespace workbench::cli
