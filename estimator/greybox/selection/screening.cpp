#include "estimator/greybox/selection/screening.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "estimator/greybox/selection/projection.h"
#include "estimator/greybox/selection/screening_memo.h"
#include "estimator/greybox/selection/screening_segment.h"
#include "estimator/greybox/selection/trial_sizes.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Largest move of a size by the linear estimate before the fit.
constexpr double kFurthest = 3.0;
/// Number of wavelengths of the coarse scan that are refined.
constexpr std::size_t kFollowed = 4;
/// Number of frequencies of a resonance from which fits start.
constexpr std::size_t kFollowedPeaks = 3;
/// Multiple of the scan's small resonance that one of usual size on the driven part is.
constexpr double kUsualSwing = 5.0;

struct ScoredStart {
  double cost = std::numeric_limits<double>::infinity();
  ParameterSubset start;
};

/// Expansion point of a screening, and the residual there without a further effect.
struct Base {
  VectorXd theta;
  VectorXd residual_m;
};

std::vector<Base> bases_of(const SearchContext& context, const ModelStage& stage) {
  const VectorXd nominal = with_file_values(context, stage);
  DatasetSimulation run(context.problem.model, context.problem.data, stage.fitted.parameters);
  MatrixXd residual_m;
  run.residuals(nominal, residual_m);
  return {{stage.fitted.theta, stage.fitted.residual_m}, {nominal, residual_m.col(0)}};
}

/// The best of several sizes of an effect from each base. All share the lanes of a simulation.
std::vector<ScoredStart> look(DatasetSimulation& run, const Projection& projection,
                              const std::vector<Base>& bases,
                              const std::vector<FreeParameter>& parameters,
                              const std::vector<FreeParameter>& own, const MatrixXd& sizes) {
  std::vector<ScoredStart> best(bases.size());
  MatrixXd residuals_m;
  const Index base_size = bases.front().theta.size();
  const Index all = sizes.cols() * static_cast<Index>(bases.size());
  const auto base_of = [&](Index point) { return static_cast<std::size_t>(point / sizes.cols()); };
  for (Index from = 0; from < all; from += ObserverSimulation::kLanes) {
    const Index lanes = std::min<Index>(ObserverSimulation::kLanes, all - from);
    MatrixXd points(base_size + sizes.rows(), lanes);
    for (Index lane = 0; lane < lanes; ++lane) {
      points.col(lane) << bases[base_of(from + lane)].theta,
          sizes.col((from + lane) % sizes.cols());
    }
    run.residuals(points, residuals_m);
    for (Index lane = 0; lane < lanes; ++lane) {
      if (!residuals_m.col(lane).allFinite()) continue;
      const Base& base = bases[base_of(from + lane)];
      const auto [cost, share] =
          projection.with(base.residual_m, base.theta, residuals_m.col(lane) - base.residual_m);
      VectorXd start = points.col(lane);
      // a limit that is not reached has no influence: start where it had some
      const bool is_limit = own.front().scale == ParameterScale::reciprocal;
      const double size = is_limit ? 1.0 : std::clamp(std::abs(share), 1.0 / kFurthest, kFurthest);
      const bool possible = scale_size(own, std::copysign(size, share), start.tail(sizes.rows()));
      // wrong sign: kept as a start only when there is no better one
      const double counted = possible ? cost : std::max(cost, projection.cost());
      ScoredStart& known = best[base_of(from + lane)];
      if (counted < known.cost) known = {counted, {parameters, std::move(start)}};
    }
  }
  return best;
}

struct Wave {
  double cost;
  double turns;
  VectorXd own;  ///< theta of the effect
};

/// Waves ranked by how well these numbers of turns over the motion explain a residual.
std::vector<Wave> waves_at(const SearchContext& context, const FitDataset& data,
                           const Projection& projection, const Base& base,
                           const std::vector<FreeParameter>& parameters,
                           const std::vector<FreeParameter>& own,
                           const std::vector<double>& turns) {
  constexpr std::size_t kTogether = ObserverSimulation::kLanes / 2;
  DatasetSimulation run(context.problem.model, data, parameters);
  std::vector<Wave> found;
  MatrixXd residuals_m;
  for (std::size_t from = 0; from < turns.size(); from += kTogether) {
    const std::size_t count = std::min(kTogether, turns.size() - from);
    MatrixXd points(base.theta.size() + static_cast<Index>(own.size()),
                    static_cast<Index>(2 * count));
    points.topRows(base.theta.size()) = base.theta.replicate(1, points.cols());
    for (std::size_t i = 0; i < count; ++i) {
      points.bottomRows(static_cast<Index>(own.size())).middleCols(static_cast<Index>(2 * i), 2) =
          waves(own, context.problem.data, turns[from + i]);
    }
    run.residuals(points, residuals_m);
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = static_cast<Index>(2 * i);
      if (!residuals_m.middleCols(at, 2).allFinite()) continue;
      const Projection::Two two =
          projection.with(base.residual_m, base.theta, residuals_m.col(at) - base.residual_m,
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

/// The best waves: all that the motion resolves on the screening segment, then a finer scan of the
/// whole record about the most promising.
std::vector<Wave> scanned(const SearchContext& context, const ModelStage& stage,
                          const Projection& projection,
                          const std::vector<FreeParameter>& parameters,
                          const std::vector<FreeParameter>& own) {
  const ScreeningSegment segment = screening_segment(context.problem.data, stage.fitted);
  const Projection there(segment.fitted, segment.data.all_mask);
  const std::vector<Wave> coarse =
      waves_at(context, segment.data, there, {stage.fitted.theta, segment.fitted.residual_m},
               parameters, own, turns_over(context.problem.data));
  std::vector<double> finer;
  for (std::size_t i = 0; i < std::min(kFollowed, coarse.size()); ++i) {
    for (const double by : {-0.375, -0.25, -0.125, 0.0, 0.125, 0.25, 0.375}) {
      finer.push_back(coarse[i].turns + by);
    }
  }
  return waves_at(context, context.problem.data, projection,
                  {stage.fitted.theta, stage.fitted.residual_m}, parameters, own, finer);
}

/// The stage's parameters, then a wave's near the length that it has.
ParameterSubset start_at(const plant_sim::EffectInfo& effect, const ModelStage& stage,
                         const std::vector<FreeParameter>& own, const Wave& wave) {
  ParameterSubset start{stage.fitted.parameters, stage.fitted.theta};
  append(start, {own, wave.own});
  hold_wavelength(effect, wave.own, std::span(start.parameters).last(own.size()));
  return start;
}

/// A resonance and how well it explains the stage's residual.
struct ScoredResonance {
  double cost = 0.0;
  double frequency_Hz = 0.0;
  double share = 0.0;
};

/// The frequencies that explain more of the residual than their neighbours, best first.
std::vector<ScoredResonance> resonance_peaks(const SearchContext& context, const ModelStage& stage,
                                             const Projection& projection,
                                             const std::vector<FreeParameter>& parameters,
                                             const std::vector<FreeParameter>& own) {
  const std::vector<double> frequencies = resonances_in(context.problem.data);
  const auto own_size = static_cast<Index>(own.size());
  const Index base_size = stage.fitted.theta.size();
  DatasetSimulation run(context.problem.model, context.problem.data, parameters);
  std::vector<ScoredResonance> scored;
  MatrixXd residuals_m;
  for (std::size_t from = 0; from < frequencies.size() && !context.cancelled();) {
    const std::size_t count =
        std::min<std::size_t>(ObserverSimulation::kLanes, frequencies.size() - from);
    const auto tried = std::span(frequencies).subspan(from, count);
    MatrixXd points(base_size + own_size, static_cast<Index>(count));
    points.topRows(base_size) = stage.fitted.theta.replicate(1, points.cols());
    points.bottomRows(own_size) = resonances(own, tried);
    run.residuals(points, residuals_m);
    for (Index lane = 0; lane < points.cols(); ++lane) {
      ScoredResonance one{projection.cost(), tried[static_cast<std::size_t>(lane)], 0.0};
      if (residuals_m.col(lane).allFinite()) {
        std::tie(one.cost, one.share) =
            projection.with(stage.fitted.residual_m, stage.fitted.theta,
                            residuals_m.col(lane) - stage.fitted.residual_m);
      }
      scored.push_back(one);
    }
    from += count;
  }
  std::vector<ScoredResonance> peaks;
  for (std::size_t i = 0; i < scored.size(); ++i) {
    const bool below = i > 0 && scored[i - 1].cost < scored[i].cost;
    const bool above = i + 1 < scored.size() && scored[i + 1].cost < scored[i].cost;
    if (!below && !above && scored[i].share != 0.0) peaks.push_back(scored[i]);
  }
  std::stable_sort(
      peaks.begin(), peaks.end(),
      [](const ScoredResonance& a, const ScoredResonance& b) { return a.cost < b.cost; });
  return peaks;
}

/// Starts at the best peaks, and with the sensor on the other side of the spring at the best, where
/// all are of one side: a resonance that pulls the plant's parameters along seems to be on either.
std::vector<ScoredStart> resonance_starts(const SearchContext& context, const ModelStage& stage,
                                          const Projection& projection,
                                          const std::vector<FreeParameter>& parameters,
                                          const std::vector<FreeParameter>& own) {
  std::vector<ScoredStart> starts;
  const std::vector<ScoredResonance> peaks =
      resonance_peaks(context, stage, projection, parameters, own);
  const auto begin_at = [&](const ScoredResonance& peak, double share) {
    const Resonance found = resonance_of(own, peak.frequency_Hz, share, context.problem.data);
    ParameterSubset start{stage.fitted.parameters, stage.fitted.theta};
    append(start, {found.parameters, found.theta});
    starts.push_back({peak.cost, std::move(start)});
  };
  bool both_sides = false;
  for (const ScoredResonance& peak : peaks) {
    if (starts.size() == kFollowedPeaks) break;
    begin_at(peak, peak.share);
    both_sides = both_sides || std::signbit(peak.share) != std::signbit(peaks.front().share);
  }
  if (!peaks.empty() && !both_sides)
    begin_at(peaks.front(), peaks.front().share > 0.0 ? -1.0 : kUsualSwing);
  return starts;
}

ScreeningResult screen_effect(const SearchContext& context, const ModelStage& stage,
                              const std::vector<Base>& bases, const Projection& projection,
                              const plant_sim::EffectInfo& effect) {
  ScreeningResult result;
  result.effect = effect.name;
  std::vector<FreeParameter> parameters = stage.fitted.parameters;
  const std::vector<FreeParameter> own = effect_parameters(effect, kFirstRefinements);
  parameters.insert(parameters.end(), own.begin(), own.end());
  std::vector<ScoredStart> starts;
  if (is_periodic(own)) {
    std::vector<Wave> found = scanned(context, stage, projection, parameters, own);
    if (!found.empty()) {
      starts.push_back({found.front().cost, start_at(effect, stage, own, found.front())});
    }
  } else if (is_resonant(own)) {
    starts = resonance_starts(context, stage, projection, parameters, own);
  } else {
    const MatrixXd sizes = trial_sizes(own, context.problem.data, context.problem.trial_sizes);
    DatasetSimulation run(context.problem.model, context.problem.data, parameters);
    starts = look(run, projection, bases, parameters, own, sizes);
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const ScoredStart& a, const ScoredStart& b) { return a.cost < b.cost; });
  double least = projection.cost();
  for (ScoredStart& scored : starts) {
    if (scored.start.parameters.empty()) continue;
    least = std::min(least, scored.cost);
    result.starts.push_back(std::move(scored.start));
  }
  result.expected_ratio = std::sqrt(std::max(least, 0.0) / projection.cost());
  return result;
}

}  // namespace

VectorXd with_file_values(const SearchContext& context, const ModelStage& stage) {
  VectorXd point = stage.fitted.theta;
  const VectorXd file = start_of(context.problem.model, context.problem.plant_parameters);
  point.head(file.size()) = file;
  return point;
}

std::vector<ScreeningResult> screen(const SearchContext& context, const ModelStage& stage,
                                    const std::vector<plant_sim::EffectInfo>& effects,
                                    const std::function<void(const std::string&)>& on_screened) {
  if (context.cancelled() || stage.fitted.jacobian.size() == 0) return {};
  const std::vector<Base> bases = bases_of(context, stage);
  const Projection projection(stage.fitted, context.problem.data.training_mask);
  std::vector<ScreeningResult> screened(effects.size());
  const std::string beside =
      context.screenings ? ScreeningMemo::key_of(context, stage) : std::string();
  const auto anew_or_known = [&](const plant_sim::EffectInfo& effect) {
    const std::string key =
        context.screenings ? beside + ScreeningMemo::key_of(context, effect) : std::string();
    return known_or<ScreeningResult>(
        context, key, [&] { return screen_effect(context, stage, bases, projection, effect); });
  };
  in_parallel(effects.size(), context.options.threads, [&](std::size_t i) {
    if (context.cancelled()) return;
    screened[i] = anew_or_known(effects[i]);
    if (on_screened) on_screened(effects[i].name);
  });
  std::erase_if(screened, [](const ScreeningResult& look) { return look.effect.empty(); });
  std::stable_sort(screened.begin(), screened.end(),
                   [](const ScreeningResult& a, const ScreeningResult& b) {
                     return a.expected_ratio < b.expected_ratio;
                   });
  return screened;
}

ParameterSubset start_of_wave(const SearchContext& context, const ModelStage& stage,
                              const plant_sim::EffectInfo& effect, double wavelength_m) {
  const std::vector<FreeParameter> own = effect_parameters(effect, kFirstRefinements);
  std::vector<FreeParameter> parameters = stage.fitted.parameters;
  parameters.insert(parameters.end(), own.begin(), own.end());
  const Projection projection(stage.fitted, context.problem.data.training_mask);
  const double turns = turns_of(context.problem.data, wavelength_m);
  const std::vector<Wave> found =
      waves_at(context, context.problem.data, projection,
               {stage.fitted.theta, stage.fitted.residual_m}, parameters, own, {turns});
  return found.empty() ? ParameterSubset{} : start_at(effect, stage, own, found.front());
}

RefinedCandidate refine(const SearchContext& context, const ScreeningResult& screened,
                        const FitOptions& options) {
  RefinedCandidate best;
  best.effect = screened.effect;
  best.fitted.training_rms_m = std::numeric_limits<double>::infinity();
  for (const ParameterSubset& start : screened.starts) {
    FitSummary fitted =
        fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
            start.parameters, start.start, options);
    if (fitted.training_rms_m < best.fitted.training_rms_m) best.fitted = std::move(fitted);
    if (context.cancelled()) break;
  }
  return best;
}

}  // namespace estimator::greybox::selection
