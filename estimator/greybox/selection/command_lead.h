// The time by which a command acts before the sample at which it is logged.
//
// Models hold each command until the next sample. A log that keeps every m-th sample of a faster
// loop, or the samples of a continuous command, shows the command at the start of an interval in
// which it goes on to change. A model that holds the mean of the interval, about
//
//   (1 - L) u(k) + L u(k+1),   L = (m - 1) / (2 m);   1/2 for a continuous command
//
// moves as far. Several m are tried, the mean being that of the cubic through u(k-1) ... u(k+2),
// and leads of whole samples, which are a shift between two clocks.
#pragma once

#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"

namespace estimator::greybox::selection {

struct SearchStart;

/// Each record's command, shifted earlier by a number of samples; its mean over an interval where
/// the number is not whole; held at a segment's ends.
void advance_command(FitDataset& data, double lead_samples);

struct CommandLead {
  double samples = 0.0;    ///< 0: as logged
  double gain_nats = 0.0;  ///< the interpolation gains it; 0 for whole samples
};

/// The lead with which the stage's model leaves much less of the error, if any; none for records of
/// several rates. With it the model as given, `first`, may not leave more than without: a lead that
/// an effect has to make up for is no fault of the log.
[[nodiscard]] CommandLead find_command_lead(const SearchContext& context, const ModelStage& first,
                                            const ModelStage& stage);

/// The same beside the effects that a search has begun with, or beside one of its first round that
/// leaves as little: without the lead, others stand in for the effect that shows it.
[[nodiscard]] CommandLead find_command_lead(const SearchContext& context, const SearchStart& start);

/// True where the noise floor is low enough to show an interpolated command: that of a slow log,
/// taken from positions far apart, is too high.
[[nodiscard]] bool floor_shows_lead(const FitDataset& data);

}  // namespace estimator::greybox::selection
