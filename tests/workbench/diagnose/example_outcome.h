// Diagnoses as they may come out, made by hand: for what is written from them.
#pragma once

#include <cmath>
#include <limits>

#include "workbench/diagnose/diagnosis_report.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

inline greybox::FitSummary example_fit(double validation_rms_m) {
  greybox::FitSummary fitted;
  fitted.theta = Eigen::VectorXd::Zero(1);
  fitted.validation_rms_m = validation_rms_m;
  return fitted;
}

inline selection::Candidate example_candidate(const std::string& effect, double validation_rms_m,
                                              double p) {
  selection::Candidate candidate;
  candidate.effects = {effect};
  candidate.fitted = example_fit(validation_rms_m);
  candidate.validation_rms_m = validation_rms_m;
  candidate.p_value = p;
  candidate.fitted_at_all = true;
  return candidate;
}

/// Friction found on one record of 26.3 um; the figures are chosen, none is computed.
struct ExampleReport : DiagnosisReport {
  ExampleReport();
  ExampleReport(const ExampleReport&) = delete;
  ExampleReport& operator=(const ExampleReport&) = delete;

  PreparedDiagnosis input;
};

inline ExampleReport::ExampleReport() {
  prepared = &input;
  input.model_file = "rig.toml";
  input.records = {"bench.csv"};
  input.command = "spoolwatch diagnose rig.toml bench.csv";
  selection::Diagnosis& d = diagnosis;
  d.verdict = selection::Verdict::missing;
  d.missing = {"friction"};
  d.noise_floor_m = 2.4e-6;
  d.nominal_rms_m = 1.42e-3;
  d.rms_before_m = 26.3e-6;
  d.rms_after_m = 2.7e-6;
  d.parameters = {{"damping_N_s_per_m", 1000.0 / 3.0, 4.0, false},
                  {"friction.coulomb_N", 145.31, 1.9, false},
                  {"friction.static_N", 181.2, 4.3, false},
                  {"friction.stribeck_mps", 0.5, std::nan(""), true}};
  d.steps = {{"", 26.3e-6}, {"friction", 2.7e-6}};
  selection::Round first;
  first.before.fitted = example_fit(26.3e-6);
  selection::Candidate hopeless;
  hopeless.effects = {"backlash"};
  first.candidates = {example_candidate("friction", 2.7e-6, 1e-12),
                      example_candidate("deadband", 9.8e-6, 0.02), hopeless};
  d.search.rounds = {first};
  d.search.final.added = {"friction"};
  d.search.final.fitted = example_fit(2.7e-6);
  d.final = d.search.final.fitted;
}

}  // namespace workbench::diagnose
