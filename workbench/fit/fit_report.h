// A finished fit as text, JSON, report and model file.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/estimation.h"
#include "workbench/fit/request.h"
#include "workbench/present/report.h"

namespace workbench::fit {

struct FitReport {
  const PreparedFit* prepared = nullptr;  ///< must outlive this
  greybox::EstimationSummary estimation;
  double noise_floor_m = 0.0;  ///< NaN: unknown
  double runtime_s = 0.0;
  std::string output;  ///< the model file that is written, or empty
};

/// Fits; `prepared` must outlive the report.
[[nodiscard]] FitReport run(const PreparedFit& prepared);

/// Summary as sentences, most important first.
[[nodiscard]] std::vector<std::string> words(const FitReport& outcome);
/// Names of the records, each once where its blocks are fitted apart.
[[nodiscard]] std::vector<std::string> record_names(const FitReport& outcome);
/// Names of the fitted parameters.
[[nodiscard]] std::vector<std::string> fitted_names(const greybox::EstimationSummary& estimation);
/// "held by its prior", "at its lower bound", ... or empty.
[[nodiscard]] std::string remark(const greybox::EstimatedParameter& parameter);
/// "large standard error"; empty for none.
[[nodiscard]] std::string to_string(greybox::IntervalDoubt doubt);
/// "fitting from 4 starts"
[[nodiscard]] std::string progress_words(const greybox::EstimationProgress& progress);
/// "gain * sqrt(pressure) and mass / pressure"; empty where no product is visible.
[[nodiscard]] std::string visible_words(const greybox::UnidentifiableParameter& unseen,
                                        const std::vector<greybox::EstimatedParameter>& parameters);
/// "only gain * sqrt(pressure) is visible: its prior holds pressure"
[[nodiscard]] std::string unidentifiable_words(
    const greybox::UnidentifiableParameter& unseen,
    const std::vector<greybox::EstimatedParameter>& parameters);

/// Words, table, profiles.
[[nodiscard]] std::string to_text(const FitReport& outcome);

/// SI throughout; a missing number is null. Keys: parameters.NAME.{value, std_error, low, high,
/// at_bound (-1, 0, 1), start, prior_mean, prior_sd, record_share, interval ("normal", "profile"),
/// remark, profile}, rms_before_m, rms_after_m, heldout_before_m, heldout_after_m,
/// free_run_before_m, free_run_after_m, fit_percent_before, fit_percent_after, noise_floor_m,
/// sigma_m (weighted the fit), starts.{tried, same, elsewhere, worse}, identifiability.{before,
/// after}.{condition, unseen: [{parameter, partners, visible, words}]}, correlation.{names,
/// matrix}, interrupted, fit_s (without reading, profiles and writing), runtime_s.
[[nodiscard]] std::string to_json(const FitReport& outcome);

[[nodiscard]] present::Report to_report(const FitReport& outcome);

/// Model file with the fitted values; its header states the fit.
[[nodiscard]] std::string to_model(const FitReport& outcome);

}  // namespace workbench::fit
