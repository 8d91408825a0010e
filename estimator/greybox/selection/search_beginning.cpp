#include "estimator/greybox/selection/search_beginning.h"

#include <cmath>
#include <utility>
#include <vector>

#include "estimator/greybox/selection/command_lead.h"
#include "estimator/greybox/selection/cross_validation.h"
#include "estimator/greybox/selection/file_values.h"
#include "estimator/greybox/selection/innovation_rivals.h"
#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/long_records.h"
#include "estimator/greybox/selection/spectral_line_candidates.h"

namespace estimator::greybox::selection {
namespace {

SearchStart begin_search(const SearchContext& context) {
  SearchStart start = start_search(context);
  continue_search(context, start);
  return start;
}

}  // namespace

bool leaves_physics_to_simulations(const SearchContext& context, const ModelStage& stage) {
  if (is_explained(context, stage) || context.cancelled()) return false;
  const SearchContext fitted = without_holdouts(context);
  InnovationSearch left;
  left.final = settled(fitted, stage, {}, Settling::once, wide(context.options.threads));
  if (!std::isfinite(left.final.minus_two_log)) return true;
  weigh_remainder(fitted, left);
  return left.physics_missing() && !(line_nats(fitted, left.final) > left.curve_nats);
}

void continue_search(const SearchContext& context, SearchStart& start) {
  const SearchBranch& branch = start.branch;
  if (branch.stage.added.size() == 1 && !branch.stalled &&
      leaves_physics_to_simulations(context, branch.stage)) {
    add_second_effect(context, start);
  }
}

void prefer_pair_to_physics(const SearchContext& context, SearchStart& start) {
  if (leaves_physics_to_simulations(context, start.branch.stage)) prefer_pair(context, start);
}

double take_command_lead(SearchContext& context, SearchContext& search, SearchStart& start) {
  if (is_explained(search, start.branch.stage) && floor_shows_lead(search.problem.data)) return 0.0;
  const CommandLead lead = find_command_lead(search, start);
  if (!(lead.samples > 0.0) || context.cancelled()) return 0.0;
  SearchContext earlier = context;
  advance_command(earlier.problem.data, lead.samples);
  earlier.problem.interpolated_nats = lead.gain_nats;
  SearchContext search_earlier = for_search(earlier);
  SearchStart other = begin_search(search_earlier);
  if (!(other.branch.stage.fitted.validation_rms_m <
        kLeadLeaves * start.branch.stage.fitted.validation_rms_m)) {
    return 0.0;  // the effects taken leave as little with the command as logged
  }
  context = std::move(earlier);
  search = std::move(search_earlier);
  start = std::move(other);
  return lead.samples;
}

bool widen_file_values(const SearchContext& search, SearchStart& start, DiagnosisProblem& problem) {
  DiagnosisProblem widened = problem;
  if (search.cancelled() || is_explained(search, start.branch.stage) ||
      !widen_strained(start.first, widened)) {
    return false;
  }
  const SearchContext wider = for_search({widened, search.options, search.memo, search.screenings});
  SearchStart other = begin_search(wider);
  const ModelStage& stage = other.branch.stage;
  if (!is_explained(wider, stage) &&
      !(stage.fitted.validation_rms_m < kFarLess * start.branch.stage.fitted.validation_rms_m)) {
    return false;
  }
  start = std::move(other);
  problem = std::move(widened);
  return true;
}

}  // namespace estimator::greybox::selection
