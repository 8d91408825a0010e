#include "estimator/greybox/selection/screening.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/greybox/selection/projection.h"
#include "estimator/greybox/selection/screening_segment.h"
#include "estimator/greybox/selection/trial_sizes.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How far the linear estimate may move a size before the fit begins.
constexpr double kFurthest = 3.0;
/// Wavelengths of the coarse scan that are looked at more closely.
constexpr std::size_t kFollowed = 4;

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
  const VectorXd nominal = with_file_values(shop, stage);
  EvidenceRun run(shop.model, shop.evidence, stage.fitted.searched);
  MatrixXd residual_m;
  run.residuals(nominal, residual_m);
  return {{stage.fitted.x, stage.fitted.residual_m}, {nominal, residual_m.col(0)}};
}

/// The best of several sizes of an effect, seen from one base.
Promise look(EvidenceRun& run, const Projection& projection, const Base& base,
             const std::vector<SearchParameter>& own, const MatrixXd& sizes) {
  Promise best;
  MatrixXd residuals_m;
  const Index base_size = base.x.size();
  for (Index from = 0; from < sizes.cols(); from += ModelRun::kLanes) {
    const Index lanes = std::min<Index>(ModelRun::kLanes, sizes.cols() - from);
    MatrixXd points(base_size + sizes.rows(), lanes);
    points.topRows(base_size) = base.x.replicate(1, lanes);
    points.bottomRows(sizes.rows()) = sizes.middleCols(from, lanes);
    run.residuals(points, residuals_m);
    for (Index lane = 0; lane < lanes; ++lane) {
      if (!residuals_m.col(lane).allFinite()) continue;
      const auto [cost, share] =
          projection.with(base.residual_m, residuals_m.col(lane) - base.residual_m);
      VectorXd start = points.col(lane);
      // a limit that is not reached has no influence: begin where it was seen to have some
      const bool is_limit = own.front().scale == Scale::reciprocal;
      const double size = is_limit ? 1.0 : std::clamp(std::abs(share), 1.0 / kFurthest, kFurthest);
      const bool possible = scale_size(own, std::copysign(size, share), start.tail(sizes.rows()));
      // of the wrong sign: still somewhere to begin, when there is nothing better
      const double counted = possible ? cost : std::max(cost, projection.cost());
      if (counted < best.cost) best = {counted, std::move(start)};
    }
  }
  return best;
}

struct Wave {
  double cost;
  double turns;
  VectorXd own;  ///< search values of the effect
};

/// How well waves of so many turns over the motion explain a residual, best first.
std::vector<Wave> waves_at(const Workshop& shop, const Evidence& evidence,
                           const Projection& projection, const Base& base,
                           const std::vector<SearchParameter>& searched,
                           const std::vector<SearchParameter>& own,
                           const std::vector<double>& turns) {
  constexpr std::size_t kTogether = ModelRun::kLanes / 2;
  EvidenceRun run(shop.model, evidence, searched);
  std::vector<Wave> found;
  MatrixXd residuals_m;
  for (std::size_t from = 0; from < turns.size(); from += kTogether) {
    const std::size_t count = std::min(kTogether, turns.size() - from);
    MatrixXd points(base.x.size() + static_cast<Index>(own.size()), static_cast<Index>(2 * count));
    points.topRows(base.x.size()) = base.x.replicate(1, points.cols());
    for (std::size_t i = 0; i < count; ++i) {
      points.bottomRows(static_cast<Index>(own.size())).middleCols(static_cast<Index>(2 * i), 2) =
          waves(own, shop.evidence, turns[from + i]);
    }
    run.residuals(points, residuals_m);
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = static_cast<Index>(2 * i);
      if (!residuals_m.middleCols(at, 2).allFinite()) continue;
      const Projection::Two two =
          projection.with(base.residual_m, residuals_m.col(at) - base.residual_m,
                          residuals_m.col(at + 1) - base.residual_m);
      found.push_back({two.cost, turns[from + i],
                       wave_of(own, points.col(at).tail(static_cast<Index>(own.size())), two.first,
                               two.second)});
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Wave& a, const Wave& b) { return a.cost < b.cost; });
  return found;
}

/// The best waves: all that the motion resolves on a short stretch of the record, then finer on the
/// whole of it about the most promising.
std::vector<Wave> scanned(const Workshop& shop, const Stage& stage, const Projection& projection,
                          const std::vector<SearchParameter>& searched,
                          const std::vector<SearchParameter>& own) {
  const Excerpt excerpt = excerpt_of(shop.evidence, stage.fitted);
  const Projection there(excerpt.fitted, excerpt.evidence.counts);
  const std::vector<Wave> coarse =
      waves_at(shop, excerpt.evidence, there, {stage.fitted.x, excerpt.fitted.residual_m}, searched,
               own, turns_over(shop.evidence));
  std::vector<double> finer;
  for (std::size_t i = 0; i < std::min(kFollowed, coarse.size()); ++i) {
    for (const double by : {-0.375, -0.25, -0.125, 0.0, 0.125, 0.25, 0.375}) {
      finer.push_back(coarse[i].turns + by);
    }
  }
  return waves_at(shop, shop.evidence, projection, {stage.fitted.x, stage.fitted.residual_m},
                  searched, own, finer);
}

Glance glance(const Workshop& shop, const Stage& stage, const std::vector<Base>& bases,
              const Projection& projection, const plant_sim::EffectInfo& effect) {
  Glance result;
  result.effect = effect.name;
  result.searched = stage.fitted.searched;
  const std::vector<SearchParameter> own = effect_parameters(effect, kFirstRefinements);
  result.searched.insert(result.searched.end(), own.begin(), own.end());
  const auto own_size = static_cast<Index>(own.size());
  std::vector<Promise> promises;
  if (is_periodic(own)) {
    std::vector<Wave> found = scanned(shop, stage, projection, result.searched, own);
    if (!found.empty()) {
      VectorXd start(stage.fitted.x.size() + own_size);
      start << stage.fitted.x, found.front().own;
      const auto first = static_cast<std::ptrdiff_t>(stage.fitted.searched.size());
      hold_wavelength(effect, found.front().own,
                      {result.searched.begin() + first, result.searched.end()});
      promises.push_back({found.front().cost, std::move(start)});
    }
  } else {
    const MatrixXd sizes = trial_sizes(own, shop.evidence);
    EvidenceRun run(shop.model, shop.evidence, result.searched);
    for (const Base& base : bases) promises.push_back(look(run, projection, base, own, sizes));
  }
  std::stable_sort(promises.begin(), promises.end(),
                   [](const Promise& a, const Promise& b) { return a.cost < b.cost; });
  double least = projection.cost();
  for (Promise& promise : promises) {
    if (promise.start.size() == 0) continue;
    least = std::min(least, promise.cost);
    result.starts.push_back(std::move(promise.start));
  }
  result.expected_ratio = std::sqrt(std::max(least, 0.0) / projection.cost());
  return result;
}

}  // namespace

VectorXd with_file_values(const Workshop& shop, const Stage& stage) {
  VectorXd point = stage.fitted.x;
  const VectorXd file = start_of(shop.model, shop.standing);
  point.head(file.size()) = file;
  return point;
}

std::vector<Glance> glances_at(const Workshop& shop, const Stage& stage,
                               const std::vector<plant_sim::EffectInfo>& effects,
                               const std::function<void(const std::string&)>& looked) {
  if (shop.cancelled() || stage.fitted.jacobian.size() == 0) return {};
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

Trial attempt(const Workshop& shop, const Glance& glance, const FitOptions& options) {
  Trial best;
  best.effect = glance.effect;
  best.fitted.fit_rms_m = std::numeric_limits<double>::infinity();
  for (const VectorXd& start : glance.starts) {
    Fitted fitted =
        fit(shop.model, shop.evidence, shop.evidence.fits, glance.searched, start, options);
    if (fitted.fit_rms_m < best.fitted.fit_rms_m) best.fitted = std::move(fitted);
    if (shop.cancelled()) break;
  }
  return best;
}

}  // namespace estimator::greybox::selection
