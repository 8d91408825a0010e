// Changes of parameters within a record as candidates of a search: which are worth a fit, and their
// numbers as free parameters.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/selection/change_scores.h"

namespace estimator::greybox::selection {

/// Name of a change among a model's effects: "change.mass_kg", "change.mass_kg@b.csv".
[[nodiscard]] std::string name_of(const ChangeScore& score);

/// A change with its numbers, ready to be fitted.
struct ChangeProposal {
  SearchContext context;  ///< its model has the change
  ModelStage start;
  ChangeScore score;
};
[[nodiscard]] ChangeProposal proposal(const SearchContext& plain, const InnovationStage& stage,
                                      const ChangeScore& score);

/// Drifts of what a constant disturbance looks like, over the whole record, within it, or towards
/// an end value: the innovations forget them.
[[nodiscard]] std::vector<ChangeScore> drifts_of(const InnovationStage& stage);

/// Changes worth a fit: the best by their scores, and those that the innovations forget at once, a
/// load that sets in and drifts of load and null.
[[nodiscard]] std::vector<ChangeScore> change_candidates(const InnovationStage& stage);

/// A ramp from the first sample to the last, to where a fitted exponential is then.
[[nodiscard]] ChangeScore ramp_throughout(const ChangeScore& exponential, const FitSummary& fitted,
                                          const Dataset& record);

/// A ramp about a fitted step: the likelihood decides whether it took time.
[[nodiscard]] ChangeScore ramp_about(const ChangeScore& step, const FitSummary& fitted,
                                     const Dataset& record);
/// An exponential in the place of a fitted ramp: the likelihood decides how it settles.
[[nodiscard]] ChangeScore settling_from(const ChangeScore& ramp, const FitSummary& fitted);
/// A change of another parameter with the course of a fitted one.
[[nodiscard]] ChangeScore with_course_of(const ChangeScore& change, const FitSummary& fitted,
                                         const ChangeScore& other);
/// A step in the middle of a fitted ramp, or a time constant after a fitted exponential begins.
[[nodiscard]] ChangeScore step_within(const ChangeScore& course, const FitSummary& fitted);

/// A change as fitted, its rivals apart; `errors` of the search values.
[[nodiscard]] ParameterChange described(const ChangeScore& score, const FitSummary& fitted,
                                        const Eigen::VectorXd& errors);

}  // namespace estimator::greybox::selection
