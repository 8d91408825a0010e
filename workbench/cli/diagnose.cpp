// `spoolwatch diagnose`: finds from records the physical effects that a model lacks.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <memory>

#include "config/record/whole_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/interrupt.h"
#include "workbench/cli/number_check.h"
#include "workbench/cli/selection_options.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/progress_line.h"
#include "workbench/diagnose/request.h"
#include "workbench/files/write_all.h"
#include "workbench/present/json.h"
#include "workbench/present/printed_axis.h"

namespace workbench::cli {

namespace selection = estimator::greybox::selection;
namespace {

using diagnose::DiagnosisReport;
using diagnose::DiagnosisRequest;

void write(const DiagnosisReport& outcome, const DiagnosisRequest& request) {
  if (request.json != "-") print(outcome, std::cout);
  const auto write_model = [&] {
    if (request.output.empty()) return;
    if (outcome.has_better_model()) {
      config::record::write_whole(request.output, better_model_text(outcome));
    } else {
      std::cerr << "spoolwatch: " << request.output
                << ": is not written, there is no better model\n";
    }
  };
  files::write_all({write_model,
                    [&] {
                      if (!request.report.empty()) write_report(report_of(outcome), request.report);
                    },
                    [&] { present::write_json(to_json(outcome), request.json); }});
}

int run(const DiagnosisRequest& request) {
  diagnose::PreparedDiagnosis prepared = prepare(request);
  const present::PrintedAxis axis(present::motion_of(prepared.problem.model));
  const Interrupt interrupt;
  diagnose::ProgressLine line(std::cerr, isatty(STDERR_FILENO) == 1,
                              prepared.problem.data.noise_floor_m);
  if (!request.quiet) {
    prepared.options.progress = [&](const selection::SearchProgress& progress) {
      line.show(progress);
    };
  }
  const auto begin = std::chrono::steady_clock::now();
  const std::chrono::duration<double> within(request.within_s);
  prepared.options.cancel = [&] {
    return Interrupt::requested() ||
           (request.within_s > 0.0 && std::chrono::steady_clock::now() - begin > within);
  };
  const DiagnosisReport report = diagnose::run(prepared, Interrupt::requested);
  if (!request.quiet) line.end();
  write(report, request);
  return Interrupt::exit_code();
}

}  // namespace

void add_diagnose(CLI::App& command, int& exit_code) {
  auto request = std::make_shared<DiagnosisRequest>();
  add_model(command, request->model);
  add_records(command, request->records);
  add_reading(command, request->reading);
  CLI::Option* const holdout = add_holdouts(command, request->holdouts);
  add_split(command, request->fit)->excludes(holdout);
  command
      .add_option("--only", request->only,
                  "name[,name...]: try these effects alone, no laws and no changes in time or "
                  "between records")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--without", request->without, "name[,name...]: do not try these effects")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_parameter_selection(command, request->selection);
  add_ignored(command, request->ignored);
  command
      .add_option("--within", request->within_s, "s: the best answer found by then; 0 is no limit")
      ->check(number_within(0.0, 1e6));
  add_json(command, request->json);
  add_report(command, request->report);
  command.add_option("-o,--output", request->output,
                     "the better model: what is missing added, all parameters fitted; with nothing "
                     "missing, the model with its parameters fitted");
  add_threads(command, request->threads);
  add_set(command, request->assignments);
  add_quiet(command, request->quiet);
  add_interrupt_footer(command);
  command.callback([request, &exit_code, &command] {
    request->command = command_line("diagnose", command);
    exit_code = run(*request);
  });
}

}  // namespace workbench::cli
