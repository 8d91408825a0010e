#include "estimator/greybox/selection/pair_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "estimator/greybox/selection/projection.h"
#include "estimator/greybox/selection/screening_segment.h"
#include "estimator/greybox/selection/search_round.h"
#include "estimator/greybox/selection/trial_sizes.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Number of the largest trial sizes of an effect that are used.
constexpr Index kPairSizes = 4;
/// Share of the distance between two sizes by which a linear estimate may lie beyond them.
constexpr double kBeyondSizes = 0.2;
/// Pairs that are fitted to the screening segment, the best of it, each from the best start seen
/// from either base: where one effect hides the other, their sizes are not those of any grid.
constexpr std::size_t kFittedToSegment = 24;
/// Of these, pairs of any one effect: one that helps beside all others would crowd these out.
constexpr std::size_t kPairsOfEffect = 6;
/// Pairs that are fitted to the whole record.
constexpr std::size_t kFittedPairs = 6;
/// Iterations on the segment; pairs within this factor of the best continue on the whole record.
constexpr int kPairIterations = 4;
constexpr double kFarPair = 3.0;
/// Fitted side by side before it is asked whether one explains the record.
constexpr std::size_t kPairWave = 2;

struct Effect {
  std::string name;
  std::vector<FreeParameter> own;
  MatrixXd sizes;
};

struct Couple {
  const Effect* first = nullptr;
  const Effect* second = nullptr;
  double cost = std::numeric_limits<double>::infinity();
  std::vector<FreeParameter> parameters;
  std::vector<VectorXd> starts;  ///< one per base
};

std::vector<Effect> effects_of(const SearchContext& context,
                               const std::vector<std::string>& without) {
  std::vector<Effect> effects;
  for (const plant_sim::EffectInfo& info : context.problem.candidate_effects) {
    if (std::find(without.begin(), without.end(), info.name) != without.end()) continue;
    Effect effect{info.name, effect_parameters(info, kFirstRefinements), {}};
    if (is_periodic(effect.own) || is_resonant(effect.own)) continue;
    effect.sizes =
        trial_sizes(effect.own, context.problem.data).leftCols(kTrialSizes).rightCols(kPairSizes);
    effects.push_back(std::move(effect));
  }
  return effects;
}

/// Residuals of every combination of sizes with the model's own parameters at `base`.
struct SizeGrid {
  MatrixXd points;       ///< one combination a column: first size i, second k in column 4 i + k
  MatrixXd residuals_m;  ///< as many columns
};

SizeGrid simulated(const plant_sim::ModelFile& model, const FitDataset& data, const VectorXd& base,
                   const Couple& couple) {
  DatasetSimulation run(model, data, couple.parameters);
  SizeGrid grid;
  grid.points.resize(base.size() + couple.first->sizes.rows() + couple.second->sizes.rows(),
                     kPairSizes * kPairSizes);
  for (Index i = 0; i < kPairSizes; ++i) {
    for (Index k = 0; k < kPairSizes; ++k) {
      grid.points.col(i * kPairSizes + k) << base, couple.first->sizes.col(i),
          couple.second->sizes.col(k);
    }
  }
  grid.residuals_m.resize(data.size(), grid.points.cols());
  MatrixXd some_m;
  for (Index from = 0; from < grid.points.cols(); from += ObserverSimulation::kLanes) {
    const Index lanes = std::min<Index>(ObserverSimulation::kLanes, grid.points.cols() - from);
    run.residuals(grid.points.middleCols(from, lanes), some_m);
    grid.residuals_m.middleCols(from, lanes) = some_m;
  }
  return grid;
}

/// Best combination of sizes at `base`: of the grid's, or between two of its sizes of either
/// effect, which may differ in sign; there the error is taken as linear.
void screened(const plant_sim::ModelFile& model, const FitDataset& data,
              const Projection& projection, const VectorXd& base, Couple& couple) {
  const SizeGrid grid = simulated(model, data, base, couple);
  double least = std::numeric_limits<double>::infinity();
  VectorXd best = grid.points.col(0);
  const auto is_between = [](double share) {
    return share > -kBeyondSizes && share < 1.0 + kBeyondSizes;
  };
  for (Index at = 0; at < grid.points.cols(); ++at) {
    const Index i = at / kPairSizes;
    const Index k = at % kPairSizes;
    const Index in_first = at + (i == 0 ? kPairSizes : -kPairSizes);
    const Index in_second = at + (k == 0 ? 1 : -1);
    const auto here_m = grid.residuals_m.col(at);
    if (!here_m.allFinite()) continue;
    VectorXd theta = grid.points.col(at);
    double cost = projection.remaining(here_m, base);
    if (grid.residuals_m.col(in_first).allFinite() && grid.residuals_m.col(in_second).allFinite()) {
      const Projection::Two two =
          projection.with(here_m, base, grid.residuals_m.col(in_first) - here_m,
                          grid.residuals_m.col(in_second) - here_m);
      if (is_between(two.first) && is_between(two.second)) {
        cost = two.cost;
        theta += two.first * (grid.points.col(in_first) - grid.points.col(at)) +
                 two.second * (grid.points.col(in_second) - grid.points.col(at));
      }
    }
    if (cost >= least) continue;
    least = cost;
    best = theta;
  }
  couple.cost = std::min(couple.cost, least);
  couple.starts.emplace_back(best);
}

/// The best of pairs in ascending order of their cost, few of any one effect.
std::vector<Couple> varied(const std::vector<Couple>& couples) {
  std::map<const Effect*, std::size_t> pairs_of;
  std::vector<Couple> kept;
  for (const Couple& couple : couples) {
    if (kept.size() == kFittedToSegment) break;
    std::size_t& of_first = pairs_of[couple.first];
    std::size_t& of_second = pairs_of[couple.second];
    if (of_first == kPairsOfEffect || of_second == kPairsOfEffect) continue;
    ++of_first;
    ++of_second;
    kept.push_back(couple);
  }
  return kept;
}

/// Screens all pairs from all bases and keeps the best, best first.
void look_at(const SearchContext& context, const FitDataset& data, const Projection& projection,
             const std::array<const VectorXd*, 2>& bases, std::vector<Couple>& couples) {
  in_parallel(couples.size(), context.options.threads, [&](std::size_t i) {
    for (const VectorXd* base : bases) {
      if (!context.cancelled())
        screened(context.problem.model, data, projection, *base, couples[i]);
    }
  });
  std::stable_sort(couples.begin(), couples.end(),
                   [](const Couple& a, const Couple& b) { return a.cost < b.cost; });
  couples = varied(couples);
}

Candidate quick_fit(const SearchContext& context, const ModelStage& stage, const Couple& couple,
                    int iterations) {
  ScreeningResult screened{couple.first->name, 1.0, {}};
  for (const VectorXd& start : couple.starts) screened.starts.push_back({couple.parameters, start});
  Candidate candidate = quick_fit(context, stage, screened, iterations);
  candidate.effects.push_back(couple.second->name);
  return candidate;
}

/// Keeps the pairs of the least errors, best first, that are not far behind the best.
void keep_best(std::vector<Candidate>& begun, std::vector<Couple>& couples) {
  std::vector<std::size_t> order(couples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return begun[a].validation_rms_m < begun[b].validation_rms_m;
  });
  const double most_m = order.empty() ? 0.0 : kFarPair * begun[order.front()].validation_rms_m;
  std::vector<Candidate> fits;
  std::vector<Couple> kept;
  for (const std::size_t i : order) {
    if (kept.size() == kFittedPairs || !(begun[i].validation_rms_m < most_m)) break;
    fits.push_back(std::move(begun[i]));
    kept.push_back(std::move(couples[i]));
  }
  begun = std::move(fits);
  couples = std::move(kept);
}

}  // namespace

std::vector<Candidate> pair_search(const SearchContext& context, const ModelStage& stage,
                                   const std::vector<std::string>& without) {
  const std::vector<Effect> effects = effects_of(context, without);
  const VectorXd nominal = with_file_values(context, stage);
  const std::array<const VectorXd*, 2> bases{&nominal, &stage.fitted.theta};
  std::vector<Couple> couples;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    for (std::size_t k = i + 1; k < effects.size(); ++k) {
      Couple couple;
      couple.first = &effects[i];
      couple.second = &effects[k];
      couple.parameters = stage.fitted.parameters;
      for (const Effect* effect : {couple.first, couple.second}) {
        couple.parameters.insert(couple.parameters.end(), effect->own.begin(), effect->own.end());
      }
      couples.push_back(std::move(couple));
    }
  }
  const ScreeningSegment segment = screening_segment(context.problem.data, stage.fitted);
  const Projection there(segment.fitted, segment.data.all_mask);
  look_at(context, segment.data, there, bases, couples);
  SearchContext on_segment = context;
  on_segment.problem.data = segment.data;
  const ModelStage before{stage.added, segment.fitted};
  std::vector<Candidate> begun(couples.size());
  in_parallel(couples.size(), context.options.threads, [&](std::size_t i) {
    if (!context.cancelled()) begun[i] = quick_fit(on_segment, before, couples[i], kPairIterations);
  });
  keep_best(begun, couples);
  std::vector<Candidate> candidates(couples.size());
  for (std::size_t from = 0; from < couples.size(); from += kPairWave) {
    in_parallel(std::min(kPairWave, couples.size() - from), context.options.threads,
                [&](std::size_t k) {
                  const std::size_t i = from + k;
                  if (context.cancelled()) return;
                  couples[i].starts = {begun[i].fitted.theta};
                  candidates[i] = quick_fit(context, stage, couples[i], kQuickIterations);
                });
    if (std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& c) {
          return c.fitted_at_all &&
                 c.validation_rms_m < kUnexplained * context.problem.data.noise_floor_m;
        })) {
      break;
    }
  }
  std::erase_if(candidates, [](const Candidate& c) { return !c.fitted_at_all; });
  refine_best(context, stage, candidates);
  return candidates;
}

}  // namespace estimator::greybox::selection
