#include "estimator/greybox/selection/command_lead.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "config/record/command_advance.h"
#include "estimator/greybox/kinematics.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/greybox/selection/structure_search.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

constexpr std::array kLeads_samples = {1.0 / 4.0, 1.0 / 3.0, 3.0 / 8.0, 9.0 / 20.0,
                                       1.0 / 2.0, 1.0,       3.0 / 2.0, 2.0};
/// Sample time from which on a floor may hide the error of a held command.
constexpr double kSlow_s = 0.015;
constexpr int kLeadIterations = 10;
/// Iterations after which a lead must leave less than none does to be fitted further.
constexpr int kLeadFirstIterations = 2;
constexpr double kLeadTolerance = 1e-3;
/// Correlation length of the interpolation error, as assumed.
constexpr double kCorrelated_samples = 4.0;

/// True where the model as given leaves more with the lead than without.
bool leaves_more(const SearchContext& context, const ModelStage& first, double lead_samples) {
  SearchContext earlier = context;
  advance_command(earlier.problem.data, lead_samples);
  return !(first_stage(earlier).fitted.validation_rms_m <=
           (1.0 + kRivals) * first.fitted.validation_rms_m);
}

}  // namespace

void advance_command(FitDataset& data, double lead_samples) {
  for (Dataset& record : data.records) {
    for (const SampleRange& span : segments(record)) {
      config::record::advance_command(
          std::span(record.u_V).subspan(span.begin, span.end - span.begin), lead_samples);
    }
    record.command_is_interpolated =
        record.command_is_interpolated || config::record::interpolates(lead_samples);
  }
}

CommandLead find_command_lead(const SearchContext& context, const ModelStage& first,
                              const ModelStage& stage) {
  const std::vector<Dataset>& records = context.problem.data.records;
  const bool one_rate = std::all_of(records.begin(), records.end(), [&](const Dataset& record) {
    return record.sample_time_s == records.front().sample_time_s;
  });
  if (!one_rate) return {};
  FitOptions options;
  options.tolerance = kLeadTolerance;
  options.final_jacobian = false;
  options.cancel = context.options.cancel;
  const ParameterSubset all = subset(stage.fitted, [](const auto&) { return true; });
  std::array<FitSummary, kLeads_samples.size()> fits;
  const auto fit_lead = [&](std::size_t i) {
    FitDataset data = context.problem.data;
    advance_command(data, kLeads_samples[i]);
    FitOptions effort = options;
    Eigen::VectorXd start = all.start;
    for (const int iterations : {kLeadFirstIterations, kLeadIterations}) {
      effort.max_iterations = iterations;
      fits[i] = fit(context.problem.model, data, data.training_mask, all.parameters, start, effort);
      if (!(fits[i].training_rms_m < stage.fitted.training_rms_m)) break;
      start = fits[i].theta;
    }
  };
  // the error falls towards a lead from either side, so that the shortest lowers it whichever it is
  fit_lead(0);
  if (!(fits[0].training_rms_m < stage.fitted.training_rms_m)) return {};
  in_parallel(fits.size() - 1, context.options.threads, [&](std::size_t i) { fit_lead(i + 1); });
  // the plant's own time constants make up for much of a lead, at odds with the file
  const double independent = context.problem.data.training_mask.sum() / kCorrelated_samples;
  const auto cost_nats = [&](const FitSummary& fitted) {
    const double rms_m = fitted.training_rms_m;
    return std::isnan(rms_m) ? std::numeric_limits<double>::infinity()
                             : independent * std::log(rms_m) + 0.5 * prior_cost(fitted);
  };
  const auto best = std::min_element(fits.begin(), fits.end(), [&](const auto& a, const auto& b) {
    return cost_nats(a) < cost_nats(b);
  });
  if (context.cancelled() || !(best->training_rms_m < kLeadLeaves * stage.fitted.training_rms_m) ||
      !(best->validation_rms_m < kLeadLeaves * stage.fitted.validation_rms_m)) {
    return {};
  }
  const double lead_samples = kLeads_samples[static_cast<std::size_t>(best - fits.begin())];
  if (!stage.added.empty() && leaves_more(context, first, lead_samples)) return {};
  if (lead_samples == std::floor(lead_samples)) return {lead_samples, 0.0};
  return {lead_samples, context.problem.data.all_mask.sum() *
                            std::log(stage.fitted.validation_rms_m / best->validation_rms_m)};
}

CommandLead find_command_lead(const SearchContext& context, const SearchStart& start) {
  const SearchBranch& branch = start.branch;
  CommandLead lead = find_command_lead(context, start.first, branch.stage);
  if (!(lead.samples > 0.0) && !branch.stage.added.empty() && !context.cancelled())
    lead = find_command_lead(context, start.first, start.first);
  if (branch.rounds.empty()) return lead;
  const std::vector<Candidate>& candidates = branch.rounds.front().candidates;
  double least_m = std::numeric_limits<double>::infinity();
  for (const Candidate& one : candidates) {
    if (one.fitted_at_all) least_m = std::min(least_m, one.validation_rms_m);
  }
  for (const Candidate& one : candidates) {
    if (lead.samples > 0.0 || context.cancelled()) break;
    if (!one.fitted_at_all || !(one.validation_rms_m <= (1.0 + kRivals) * least_m)) continue;
    const ModelStage rival = with(start.first, one);
    if (rival.added != branch.stage.added) lead = find_command_lead(context, start.first, rival);
  }
  return lead;
}

bool floor_shows_lead(const FitDataset& data) {
  return std::all_of(data.records.begin(), data.records.end(),
                     [](const Dataset& record) { return record.sample_time_s < kSlow_s; });
}

}  // namespace estimator::greybox::selection
