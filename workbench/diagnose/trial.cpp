#include "workbench/diagnose/trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "workbench/diagnose/excerpt.h"
#include "workbench/diagnose/parallel.h"
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

/// Where to look from, and the residual there without any further effect.
struct Base {
  VectorXd x;
  VectorXd residual_m;
};

std::vector<Base> bases_of(const Workshop& shop, const Stage& stage) {
  VectorXd nominal = stage.fitted.x;
  const VectorXd file = matching::start_of(shop.model, shop.standing);
  nominal.head(file.size()) = file;
  matching::EvidenceRun run(shop.model, shop.evidence, stage.fitted.searched);
  MatrixXd residual_m;
  run.residuals(nominal, residual_m);
  return {{stage.fitted.x, stage.fitted.residual_m}, {nominal, residual_m.col(0)}};
}

/// The best of several sizes of an effect, seen from one base.
Promise look(matching::EvidenceRun& run, const Projection& projection, const Base& base,
             const std::vector<SearchParameter>& own, const MatrixXd& sizes) {
  Promise best;
  MatrixXd residuals_m;
  const Index base_size = base.x.size();
  for (Index from = 0; from < sizes.cols(); from += matching::ModelRun::kLanes) {
    const Index lanes = std::min<Index>(matching::ModelRun::kLanes, sizes.cols() - from);
    MatrixXd points(base_size + sizes.rows(), lanes);
    points.topRows(base_size) = base.x.replicate(1, lanes);
    points.bottomRows(sizes.rows()) = sizes.middleCols(from, lanes);
    run.residuals(points, residuals_m);
    for (Index lane = 0; lane < lanes; ++lane) {
      if (!residuals_m.col(lane).allFinite()) continue;
      const auto [cost, share] =
          projection.with(base.residual_m, residuals_m.col(lane) - base.residual_m);
      VectorXd start = points.col(lane);
      const double size = std::clamp(std::abs(share), 1.0 / kFurthest, kFurthest);
      const bool possible = scale_size(own, std::copysign(size, share), start.tail(sizes.rows()));
      // of the wrong sign: still somewhere to begin, when there is nothing better
      const double counted = possible ? cost : std::max(cost, projection.cost());
      if (counted < best.cost) best = {counted, std::move(start)};
    }
  }
  return best;
}

/// The most promising wavelengths, from a short stretch of the record.
MatrixXd scanned(const Workshop& shop, const Stage& stage,
                 const std::vector<SearchParameter>& searched,
                 const std::vector<SearchParameter>& own) {
  const Excerpt excerpt = excerpt_of(shop.evidence, stage.fitted);
  const MatrixXd waves = wavelengths(own, shop.evidence);
  matching::EvidenceRun run(shop.model, excerpt.evidence, searched);
  const Projection projection(excerpt.fitted, excerpt.evidence.counts);
  const Base base{stage.fitted.x, excerpt.fitted.residual_m};
  std::vector<std::pair<double, Index>> ranking;
  for (Index i = 0; i < waves.cols(); i += matching::ModelRun::kLanes) {
    const Index lanes = std::min<Index>(matching::ModelRun::kLanes, waves.cols() - i);
    MatrixXd points(base.x.size() + waves.rows(), lanes);
    points.topRows(base.x.size()) = base.x.replicate(1, lanes);
    points.bottomRows(waves.rows()) = waves.middleCols(i, lanes);
    MatrixXd residuals_m;
    run.residuals(points, residuals_m);
    for (Index lane = 0; lane < lanes; ++lane) {
      if (!residuals_m.col(lane).allFinite()) continue;
      ranking.emplace_back(
          projection.with(base.residual_m, residuals_m.col(lane) - base.residual_m).first,
          i + lane);
    }
  }
  std::sort(ranking.begin(), ranking.end());
  ranking.resize(std::min<std::size_t>(ranking.size(), matching::ModelRun::kLanes));
  MatrixXd best(waves.rows(), static_cast<Index>(ranking.size()));
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    best.col(static_cast<Index>(i)) = waves.col(ranking[i].second);
  }
  return best;
}

Glance glance(const Workshop& shop, const Stage& stage, const std::vector<Base>& bases,
              const Projection& projection, const plant_sim::EffectInfo& effect) {
  Glance result;
  result.effect = effect.name;
  result.searched = stage.fitted.searched;
  std::vector<SearchParameter> own = matching::effect_parameters(effect, kFirstRefinements);
  result.searched.insert(result.searched.end(), own.begin(), own.end());
  const MatrixXd sizes = is_periodic(own) ? scanned(shop, stage, result.searched, own)
                                          : trial_sizes(own, shop.evidence);
  matching::EvidenceRun run(shop.model, shop.evidence, result.searched);
  std::vector<Promise> promises;
  for (const Base& base : bases) promises.push_back(look(run, projection, base, own, sizes));
  std::stable_sort(promises.begin(), promises.end(),
                   [](const Promise& a, const Promise& b) { return a.cost < b.cost; });
  for (Promise& promise : promises) {
    if (promise.start.size() > 0) result.starts.push_back(std::move(promise.start));
  }
  const double least = std::min(projection.cost(), promises.front().cost);
  result.expected_ratio = std::sqrt(least / projection.cost());
  if (is_periodic(own) && !result.starts.empty()) {
    const auto first = static_cast<std::ptrdiff_t>(stage.fitted.searched.size());
    hold_wavelength(effect, result.starts.front().tail(sizes.rows()),
                    {result.searched.begin() + first, result.searched.end()});
    result.starts.resize(1);
  }
  return result;
}

}  // namespace

std::vector<Glance> glances_at(const Workshop& shop, const Stage& stage,
                               const std::vector<plant_sim::EffectInfo>& effects,
                               const std::function<void(const std::string&)>& looked) {
  const std::vector<Base> bases = bases_of(shop, stage);
  const Projection projection(stage.fitted, shop.evidence.fits);
  std::vector<Glance> glances(effects.size());
  in_parallel(effects.size(), shop.threads, [&](std::size_t i) {
    if (shop.cancelled()) return;
    glances[i] = glance(shop, stage, bases, projection, effects[i]);
    if (looked) looked(effects[i].name);
  });
  std::erase_if(glances, [](const Glance& look) { return look.effect.empty(); });
  std::stable_sort(glances.begin(), glances.end(), [](const Glance& a, const Glance& b) {
    return a.expected_ratio < b.expected_ratio;
  });
  return glances;
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
