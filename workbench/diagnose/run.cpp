#include "estimator/greybox/selection/command_lead.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/experiment_design.h"
#include "workbench/diagnose/model_residuals.h"

namespace workbench::diagnose {

DiagnosisReport run(PreparedDiagnosis& prepared, const std::function<bool()>& interrupted) {
  AdvisedDiagnosis found = workbench::diagnose::diagnose(prepared.problem, prepared.options);
  DiagnosisReport report{&prepared, std::move(found.diagnosis), std::move(found.advice)};
  selection::advance_command(prepared.problem.data, report.diagnosis.command_lead_samples);
  for (const selection::Law& law : report.diagnosis.laws) {
    prepared.problem.model.declare(law.effect, prepared.model_file);
  }
  report.interrupted = interrupted() || report.diagnosis.search.interrupted;
  simulate_freely(report);
  return report;
}

}  // namespace workbench::diagnose
