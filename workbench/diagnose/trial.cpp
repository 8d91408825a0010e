#include "workbench/diagnose/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "workbench/diagnose/projection.h"
#include "workbench/diagnose/sizes.h"

namespace workbench::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using matching::SearchParameter;

/// How far the linear estimate may move a size before the fit begins.
constexpr double kFurthest = 3.0;

struct Promise {
  double cost = std::numeric_limits<double>::infinity();
  VectorXd start;
};

}  // namespace

Glance glance(const Workshop& shop, const Stage& stage, const std::vector<VectorXd>& bases,
              const plant_sim::EffectInfo& effect) {
  Glance result;
  result.effect = effect.name;
  result.searched = stage.fitted.searched;
  const std::vector<SearchParameter> own = matching::effect_parameters(effect, kFirstRefinements);
  result.searched.insert(result.searched.end(), own.begin(), own.end());
  const auto base_size = static_cast<Index>(stage.fitted.searched.size());
  const auto own_size = static_cast<Index>(own.size());

  matching::EvidenceRun run(shop.model, shop.evidence, result.searched);
  const Projection projection(stage.fitted, shop.evidence.fits);
  const MatrixXd sizes = trial_sizes(own, shop.evidence);
  std::vector<Promise> promises(bases.size());
  MatrixXd residuals_m;
  MatrixXd none_m;
  double least = projection.cost();
  for (std::size_t b = 0; b < bases.size(); ++b) {
    VectorXd rest(base_size + own_size);
    rest << bases[b], neutral_point(own);
    run.residuals(rest, none_m);
    for (Index from = 0; from < sizes.cols(); from += matching::ModelRun::kLanes) {
      const Index lanes = std::min<Index>(matching::ModelRun::kLanes, sizes.cols() - from);
      MatrixXd points(base_size + own_size, lanes);
      points.topRows(base_size) = bases[b].replicate(1, lanes);
      points.bottomRows(own_size) = sizes.middleCols(from, lanes);
      run.residuals(points, residuals_m);
      for (Index lane = 0; lane < lanes; ++lane) {
        if (!residuals_m.col(lane).allFinite()) continue;
        const auto [cost, share] =
            projection.with(none_m.col(0), residuals_m.col(lane) - none_m.col(0));
        VectorXd start = points.col(lane);
        const double size = std::clamp(std::abs(share), 1.0 / kFurthest, kFurthest);
        const bool possible = scale_size(own, std::copysign(size, share), start.tail(own_size));
        // of the wrong sign: still somewhere to begin, when there is nothing better
        const double counted = possible ? cost : std::max(cost, projection.cost());
        if (counted >= promises[b].cost) continue;
        promises[b] = {counted, std::move(start)};
      }
    }
    least = std::min(least, promises[b].cost);
  }
  std::stable_sort(promises.begin(), promises.end(),
                   [](const Promise& a, const Promise& b) { return a.cost < b.cost; });
  for (Promise& promise : promises) {
    if (promise.start.size() > 0) result.starts.push_back(std::move(promise.start));
  }
  result.expected_ratio = std::sqrt(least / projection.cost());
  return result;
}

Trial attempt(const Workshop& shop, const Glance& glance, const matching::FitOptions& options) {
  Trial best;
  best.effect = glance.effect;
  best.fitted.fit_rms_m = std::numeric_limits<double>::infinity();
  for (const VectorXd& start : glance.starts) {
    matching::Fitted fitted = matching::fit(shop.model, shop.evidence, shop.evidence.fits,
                                            glance.searched, start, options);
    if (fitted.fit_rms_m < best.fitted.fit_rms_m) best.fitted = std::move(fitted);
    if (shop.cancelled()) break;
  }
  return best;
}

}  // namespace workbench::diagnose
