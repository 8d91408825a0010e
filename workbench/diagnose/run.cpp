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
  const bool by_user = interrupted();
  report.interrupted = by_user || report.diagnosis.search.interrupted;
  report.out_of_time = report.interrupted && !by_user && prepared.within_s > 0.0;
  simulate_freely(report);
  return report;
}

}  // namespace workbench::diagnose
