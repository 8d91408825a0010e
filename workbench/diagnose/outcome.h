// A diagnosis together with what it was made from: what text, JSON, model file and report are
// written from.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/selection/diagnosis.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

struct Outcome {
  selection::Workshop shop;
  selection::Diagnosis diagnosis;
  std::string advice;
  std::string model_file;
  std::vector<std::string> records;   ///< as given: fitted, and scored by the split
  std::vector<std::string> holdouts;  ///< as given: scored only
  std::string output;                 ///< the better model's file; empty: none is written
  std::string command;                ///< that made this, as for a shell
  greybox::Split split = greybox::Split::blocks;
  bool interrupted = false;
  /// Free run from each segment's first sample, all samples; NaN when nothing was fitted.
  double free_run_before_m = std::numeric_limits<double>::quiet_NaN();  ///< the file as it is
  double free_run_after_m = std::numeric_limits<double>::quiet_NaN();   ///< the better model

  /// False when the records did not move enough for anything to be fitted.
  [[nodiscard]] bool fitted() const { return diagnosis.final.x.size() > 0; }
};

/// Measured less modelled position of the long series, under the observer or without (0).
[[nodiscard]] Eigen::VectorXd residual_of_file_m(const selection::Workshop& shop,
                                                 double observer_per_s);
[[nodiscard]] Eigen::VectorXd residual_of_m(const selection::Workshop& shop,
                                            const greybox::Fitted& fitted, double observer_per_s);

/// Fills in the free-run errors.
void simulate_freely(Outcome& outcome);

/// The effects that a round's winner brought, empty when nothing was taken.
[[nodiscard]] std::vector<std::string> taken_in(const selection::Ladder& ladder, std::size_t round);
/// Whether one of these effects is left in the end: what a round takes may be dropped later.
[[nodiscard]] bool stayed(const selection::Ladder& ladder, const std::vector<std::string>& effects);
/// The round that decided: the last in which something was taken that stayed, or else the last.
/// Rounds there must be.
[[nodiscard]] std::size_t deciding_round(const selection::Ladder& ladder);

}  // namespace workbench::diagnose
