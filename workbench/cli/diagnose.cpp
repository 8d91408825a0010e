// spoolwatch diagnose: which physical effect a model misses, learnt from records.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "config/record/whole_file.h"
#include "workbench/cli/command.h"
#include "workbench/cli/interrupt.h"
#include "workbench/cli/number_check.h"
#include "workbench/diagnose/better_model.h"
#include "workbench/diagnose/experiment_design.h"
#include "workbench/diagnose/json.h"
#include "workbench/diagnose/progress_line.h"
#include "workbench/diagnose/report_pages.h"
#include "workbench/diagnose/request.h"
#include "workbench/diagnose/text_output.h"

namespace workbench::cli {

namespace selection = estimator::greybox::selection;
namespace {

using diagnose::DiagnosisReport;
using diagnose::DiagnosisRequest;

constexpr int kMostThreads = 256;

void write(const DiagnosisReport& outcome, const DiagnosisRequest& request) {
  const bool stdout_is_json = request.json == "-";
  if (!stdout_is_json) print(outcome, std::cout);
  if (!request.output.empty()) {
    if (outcome.fitted()) {
      config::record::write_whole(request.output, better_model_text(outcome));
    } else {
      std::cerr << "spoolwatch: " << request.output
                << ": is not written, there is no better model\n";
    }
  }
  if (!request.report.empty()) write_report(report_of(outcome), request.report);
  if (stdout_is_json) {
    std::cout << to_json(outcome);
  } else if (!request.json.empty()) {
    config::record::write_whole(request.json, to_json(outcome));
  }
}

int run(const DiagnosisRequest& request) {
  diagnose::PreparedDiagnosis prepared = prepare(request);
  const Interrupt interrupt;
  diagnose::ProgressLine line(std::cerr, isatty(STDERR_FILENO) == 1,
                              prepared.problem.data.noise_floor_m);
  if (!request.quiet) {
    prepared.options.progress = [&](const selection::Progress& progress) { line.show(progress); };
  }
  prepared.options.cancel = Interrupt::requested;
  diagnose::AdvisedDiagnosis found = diagnose::diagnose(prepared.problem, prepared.options);
  if (!request.quiet) line.end();
  const int exit_code = Interrupt::exit_code();
  DiagnosisReport report{&prepared, std::move(found.diagnosis), std::move(found.advice)};
  report.interrupted = exit_code != 0 || report.diagnosis.search.interrupted;
  simulate_freely(report);
  write(report, request);
  return exit_code;
}

}  // namespace

void add_diagnose(CLI::App& command, int& exit_code) {
  auto request = std::make_shared<DiagnosisRequest>();
  command.add_option("MODEL", request->model, "a model file (TOML)")->required();
  command
      .add_option(
          "RECORD", request->records,
          "CSV or MAT (t_s,u_V,y_m), or LCM log; several are fitted together, each at its own rate")
      ->required();
  CLI::Option* const holdout =
      command.add_option("--holdout", request->holdouts, "a record that only scores, not fitted")
          ->allow_extra_args(false);
  command.add_option("--fit", request->fit, "part of each record that is fitted; the rest scores")
      ->check(CLI::IsMember({"blocks", "first-half", "second-half"}))
      ->capture_default_str()
      ->excludes(holdout);
  command.add_option("--json", request->json, "file for JSON, - for standard output");
  command.add_option("--report", request->report, "file for the report, one HTML page");
  command.add_option("-o,--output", request->output,
                     "the better model: what is missing added, all parameters fitted; with nothing "
                     "missing, the model with its parameters fitted");
  command.add_option("--threads", request->threads, "default: one for each processor")
      ->check(number_within(1, kMostThreads));
  command
      .add_option("--set", request->assignments, "table.key=value of the model file, for this run")
      ->allow_extra_args(false);
  command.add_flag("--quiet", request->quiet, "no progress on standard error");
  command.footer(
      "Ctrl-C ends it early: the best so far is printed and written, marked as interrupted, and "
      "the exit code is 130; a second Ctrl-C ends the program at once.");
  command.callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace workbench::cli
