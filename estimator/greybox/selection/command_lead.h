// The time by which a command acts before the sample at which it is logged
// (config/record/command_advance.h).
//
// Several logs that keep every m-th sample are tried, and leads of whole samples, which are a shift
// between two clocks.
#pragma once

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

struct SearchStart;

/// Each record's command, shifted earlier by a number of samples; each segment by itself.
void advance_command(FitDataset& data, double lead_samples);

/// Share of the error that may remain with a lead: a valve faster than expected gains less.
inline constexpr double kLeadLeaves = 0.6;

struct CommandLead {
  double samples = 0.0;    ///< 0: as logged
  double gain_nats = 0.0;  ///< the interpolation gains it; 0 for whole samples
};

/// The lead with which the stage's model leaves much less of the error, if any; none for records of
/// several rates. With it the model as given, `first`, may not leave more than without: a lead that
/// an effect has to make up for is no fault of the log.
[[nodiscard]] CommandLead find_command_lead(const SearchContext& context, const ModelStage& first,
                                            const ModelStage& stage);

/// The same beside the effects that a search has begun with, without any, or beside one of its
/// first round that leaves as little: without the lead, others stand in for the effect that shows
/// it.
[[nodiscard]] CommandLead find_command_lead(const SearchContext& context, const SearchStart& start);

/// True where the noise floor is low enough to show an interpolated command: that of a slow log,
/// taken from positions far apart, is too high.
[[nodiscard]] bool floor_shows_lead(const FitDataset& data);

}  // namespace estimator::greybox::selection
