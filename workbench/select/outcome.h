// The comparison of structures on one record: how each is judged, and what is recommended.
//
// Fitted on the first part of the record, scored on the rest. One period of the motion (2 s unless
// told) is the unit, as in the thesis: E is the energy of the free run's error over one held-out
// period, the free run starting from what the predictor knows after the 0.25 s before; the spread
// of coefficients is that between fits to single periods of the whole record.
//
//   AICc = N ln(V/N) + 2 p + 2 p (p + 1) / (N - p - 1),   BIC = N ln(V/N) + p ln N
//   V: one-step energy over the N samples fitted, the same samples for every structure
//   spread = sqrt(mean over coefficients of (std_i / size_i)^2), size_i: largest of its polynomial
//
// Sources: Song 2002, chapter 3 (cost, variance, on-line ability); L. Ljung, System Identification,
// 16.4; K. P. Burnham, D. R. Anderson, Model Selection and Multimodel Inference, 2002 (AICc).
#pragma once

#include <string>
#include <vector>

#include "config/record/record.h"
#include "config/signals/nan.h"
#include "estimator/structures/instrumental.h"
#include "workbench/select/candidate.h"

namespace workbench::select {

using config::signals::kNaN;

struct SelectRequest {
  std::string record;
  config::record::ReadOptions reading;
  std::vector<std::string> structures;  ///< empty: the usual ones
  int delay = -1;                       ///< samples; -1: found
  double period_s = 2.0;
  double fit_share = 0.5;  ///< first part of the record, fitted
  bool constant = true;
  bool de_mean = true;   ///< the mean of y over the fitted part is taken off
  unsigned threads = 0;  ///< 0: one for each processor
  bool quiet = false;
  std::string json;
};

/// Recursive estimation of the structure: is there a sound method, and which.
struct OnLine {
  bool sound = false;  ///< in theory, and it came to the batch fit on this record
  std::string method;  ///< "RLS", "RML, RELS", "RPEM", "none"
  std::string why;     ///< none: in words
  /// Run over the fitted part, scored like the batch fit; NaN where there is none.
  double free_run_rms_m = kNaN;
};

struct JudgedStructure {
  StructureCandidate candidate;
  Fitted fitted;
  double one_step_rms_m = kNaN;         ///< held out
  double free_run_rms_m = kNaN;         ///< held out, over single periods
  double free_run_whole_rms_m = kNaN;   ///< held out, in one go
  double cost_m2 = kNaN;                ///< E, mean over the held-out periods
  std::vector<double> period_costs_m2;  ///< each held-out period's
  double fit_percent = kNaN;            ///< 100 (1 - free_run_rms / sd of y held out)
  double aicc = kNaN;
  double bic = kNaN;
  double whiteness_p = kNaN;  ///< over the fitted one-step errors
  double spread = kNaN;
  std::vector<double> period_mean;      ///< mean of each coefficient
  std::vector<double> period_variance;  ///< likewise
  int periods = 0;                      ///< fits behind them
  OnLine on_line;
  bool has_bias_test = false;  ///< ARX alone
  structures::BiasTest bias;
  double fit_s = 0.0;
  bool represents = false;  ///< its free-run error is less than y moves
};

struct SelectOutcome {
  SelectRequest request;
  std::string name;
  double sample_time_s = 0.0;
  std::size_t samples = 0;
  std::size_t gaps = 0;
  int delay = 1;
  double fitted_to_s = 0.0;
  double scored_to_s = 0.0;
  double from_s = 0.0;
  double period_s = 0.0;
  int held_out_periods = 0;
  double noise_floor_m = kNaN;
  std::vector<JudgedStructure> judged;  ///< best first
  int recommended = -1;                 ///< index; -1: none represents the record
  int most_accurate = -1;
  int watch = -1;  ///< the one to follow on line; -1: none
  std::string reason;
  std::string bias_words;
  std::vector<std::string> notes;
  bool interrupted = false;
  double runtime_s = 0.0;
};

/// Progress of the comparison.
struct SelectProgress {
  std::string doing;
  std::size_t done = 0;
  std::size_t of = 0;
};

/// Throws config::schema::DataError for a record that cannot be compared on, UsageError for a wish
/// that cannot be granted.
[[nodiscard]] SelectOutcome compare_structures(
    const SelectRequest& request, const std::function<void(const SelectProgress&)>& progress,
    const std::function<bool()>& cancel);

/// Sorts `outcome.judged`, chooses, and finds the words.
void recommend(SelectOutcome& outcome);

/// Recursive form of `judged`, from its family and its poles.
[[nodiscard]] OnLine on_line_form(const StructureCandidate& candidate, const Fitted& fitted);

[[nodiscard]] std::string to_text(const SelectOutcome& outcome);
[[nodiscard]] std::string to_json(const SelectOutcome& outcome);

}  // namespace workbench::select
