#include "estimator/greybox/selection/innovation_search.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <mutex>
#include <numbers>
#include <numeric>
#include <utility>

#include "estimator/greybox/selection/innovation_curves.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/projection.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

using disturbance::NoiseModel;
using disturbance::SpectralLine;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kMostEffects = 4;
constexpr std::size_t kMostLines = 4;
/// Effects whose linear estimate promises less are not fitted.
constexpr double kHopeless_nats = 4.0;
/// That many are fitted with the stage's gains; that many get a noise model of their own.
constexpr std::size_t kFitted = 8;
constexpr std::size_t kFinalists = 3;
/// Of the most promising in a simulation, so many are fitted; so many of these are tried further,
/// when they leave less than this share of the error.
constexpr std::size_t kSimulated = 4;
constexpr std::size_t kSimulatedStarts = 2;
constexpr double kWorthSimulating = 0.97;
constexpr int kQuickIterations = 10;
constexpr double kQuickTolerance = 2e-4;
constexpr int kIterations = 25;
constexpr double kTolerance = 1e-5;
/// Fall of -2 log L below which another turn of noise model and parameters is of no use.
constexpr double kSettled = 1.0;
constexpr int kMostTurns = 5;
/// Amplitude of the motion over the RMS of a line at the same frequency.
constexpr double kFollows = 4.0;
constexpr std::size_t kLargestGroup = 3;
constexpr double kParametersOfLine = 3.0;
/// A rival this far behind with the stage's gains may be level with a noise model of its own.
constexpr double kWorthSettling_nats = 60.0;

double squares(const FitSummary& fitted, double floor_m) {
  return fitted.residual_m.squaredNorm() / (floor_m * floor_m);
}

double prior_cost(const FitSummary& fitted) {
  double sum = 0.0;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    const double off = (fitted.theta[static_cast<Index>(i)] - p.prior_mean) / p.prior_sd;
    if (std::isfinite(off)) sum += off * off;
  }
  return sum;
}

SearchContext with_data(const SearchContext& context, FitDataset data) {
  SearchContext result = context;
  result.problem.data = std::move(data);
  return result;
}

FitSummary fit_innovations(const SearchContext& context, const ParameterSubset& parameters,
                           Width width, bool quick) {
  FitOptions options;
  options.max_iterations = quick ? kQuickIterations : kIterations;
  options.tolerance = quick ? kQuickTolerance : kTolerance;
  options.passes = quick ? 1 : 2;
  options.final_jacobian = !quick;
  options.cancel = context.options.cancel;
  options.width = width;
  return fit(context.problem.model, context.problem.data, context.problem.data.training_mask,
             parameters.parameters, parameters.start, options);
}

/// The stage's data, likelihood and parameters for its noise model. The parameters start where they
/// are and, as a disturbance that was not known may have bent them, where the model file has them.
void refit(const SearchContext& plain, InnovationStage& stage, bool from_file_too, Width width) {
  const disturbance::InnovationData data =
      disturbance::innovation_data(plain.problem.data, stage.linear, stage.noise);
  stage.context = with_data(plain, data.data);
  ParameterSubset all = subset(stage.model.fitted, [](const auto&) { return true; });
  FitSummary fitted = fit_innovations(stage.context, all, width, false);
  if (from_file_too) {
    all.start = with_file_values(stage.context, stage.model);
    FitSummary other = fit_innovations(stage.context, all, width, false);
    const double floor_m = plain.problem.data.noise_floor_m;
    if (squares(other, floor_m) + prior_cost(other) <
        squares(fitted, floor_m) + prior_cost(fitted)) {
      fitted = std::move(other);
    }
  }
  stage.model.fitted = std::move(fitted);
  stage.minus_two_log = squares(stage.model.fitted, plain.problem.data.noise_floor_m) +
                        data.log_determinant + prior_cost(stage.model.fitted);
}

/// Noise model and parameters in turn, at most `times` over, keeping the best.
InnovationStage settled(const SearchContext& plain, ModelStage model, const NoiseModel& start,
                        int times, Width width) {
  InnovationStage stage;
  stage.model = std::move(model);
  stage.noise = start;
  stage.context = plain;
  InnovationStage best;
  for (int i = 0; i < times && !plain.cancelled(); ++i) {
    const FitSummary& fitted = stage.model.fitted;
    stage.linear = disturbance::linearise(plain.problem.model, plain.problem.data,
                                          fitted.parameters, fitted.theta);
    stage.noise =
        disturbance::estimate_noise(plain.problem.model, plain.problem.data, fitted.parameters,
                                    fitted.theta, stage.linear, stage.noise, width.threads)
            .noise;
    refit(plain, stage, i == 0, width);
    const double gain = best.minus_two_log - stage.minus_two_log;
    if (gain > 0.0) best = stage;
    if (gain < kSettled) break;
  }
  return best;
}

struct ScoredLine {
  SpectralLine line;
  double gain_nats = 0.0;
};

double line_gain_nats(const InnovationStage& stage, const Projection& projection,
                      const SpectralLine& line, std::size_t record, Index at) {
  const FitDataset& data = stage.context.problem.data;
  const MatrixXd response = disturbance::line_response(stage.linear[record], data.records[record],
                                                       *data.records[record].innovations, line);
  MatrixXd whole = MatrixXd::Zero(data.size(), 2);
  whole.middleRows(at, response.rows()) = response;
  const double size = whole.norm();
  if (!(size > 0.0)) return 0.0;
  whole *= stage.model.fitted.residual_m.norm() / size;
  const Projection::Two two =
      projection.with(stage.model.fitted.residual_m, whole.col(0), whole.col(1));
  const double sigma = stage.model.fitted.sigma_m / data.noise_floor_m;
  return 0.5 * (projection.cost() - two.cost) * sigma * sigma;
}

/// Amplitude of a series at a frequency, Hann's window.
double amplitude_at(const VectorXd& series, double frequency_Hz, double sample_time_s) {
  const double size = static_cast<double>(series.size());
  const double mean = series.mean();
  std::complex<double> sum = 0.0;
  for (Index k = 0; k < series.size(); ++k) {
    const double at = static_cast<double>(k);
    const double window = 1.0 - std::cos(2.0 * std::numbers::pi * at / size);
    sum += window * (series[k] - mean) *
           std::polar(1.0, -2.0 * std::numbers::pi * frequency_Hz * sample_time_s * at);
  }
  return 2.0 * std::abs(sum) / size;
}

/// A line where the model itself moves is a fault of the model, no disturbance.
bool follows_motion(const InnovationStage& stage, std::size_t record, const VectorXd& motion_m,
                    const VectorXd& innovations, const SpectralLine& line) {
  const Dataset& data = stage.context.problem.data.records[record];
  const double own_m = disturbance::line_amplitudes(stage.linear[record], data, *data.innovations,
                                                    {line}, innovations)
                           .front()
                           .rms_m;
  return amplitude_at(motion_m, line.frequency_Hz, data.sample_time_s) > kFollows * own_m;
}

/// The best spectral line about each promising frequency, best first; of the longest record.
std::vector<ScoredLine> lines_of(const SearchContext& plain, const InnovationStage& stage) {
  const FitDataset& data = stage.context.problem.data;
  std::size_t record = 0;
  for (std::size_t r = 1; r < data.records.size(); ++r) {
    if (data.records[r].size() > data.records[record].size()) record = r;
  }
  const auto at = static_cast<Index>(data.starts[record]);
  const Dataset& longest = data.records[record];
  const auto size = static_cast<Index>(longest.size());
  const Projection projection(stage.model.fitted, data.training_mask);
  const VectorXd innovations = stage.model.fitted.residual_m.segment(at, size);
  const VectorXd motion_m = Eigen::Map<const VectorXd>(longest.y_m.data(), size) -
                            simulated(plain, stage.model.fitted).residual_m.segment(at, size);
  std::vector<SpectralLine> promising = disturbance::promising_lines(
      stage.linear[record], longest, *longest.innovations, innovations);
  std::vector<ScoredLine> scored(promising.size());
  const double bin_Hz = 1.0 / (longest.sample_time_s * static_cast<double>(size));
  in_parallel(promising.size(), stage.context.options.threads, [&](std::size_t i) {
    SpectralLine line = promising[i];
    double best = line_gain_nats(stage, projection, line, record, at);
    for (double step_Hz = 0.5 * bin_Hz; step_Hz > 0.02 * bin_Hz; step_Hz *= 0.5) {
      for (const double sign : {-1.0, 1.0}) {
        SpectralLine moved = line;
        moved.frequency_Hz += sign * step_Hz;
        const double gain = line_gain_nats(stage, projection, moved, record, at);
        if (gain > best) {
          best = gain;
          line = moved;
          break;
        }
      }
    }
    const bool disturbs =
        best > kPerParameter_nats && !follows_motion(stage, record, motion_m, innovations, line);
    scored[i] = {line, disturbs ? best : 0.0};
  });
  std::erase_if(scored, [](const ScoredLine& line) { return !(line.gain_nats > 0.0); });
  std::stable_sort(scored.begin(), scored.end(), [](const ScoredLine& a, const ScoredLine& b) {
    return a.gain_nats > b.gain_nats;
  });
  return scored;
}

struct Trial {
  InnovationCandidate candidate;
  std::vector<ModelStage> starts;  ///< fitted with the stage's gains, with the weak observer
  double penalty_nats = 0.0;
  bool simulated = false;  ///< promising in a simulation with the weak observer
};

ModelStage with_effect(const ModelStage& stage, const std::string& effect, FitSummary fitted) {
  ModelStage next{stage.added, std::move(fitted)};
  next.added.push_back(effect);
  return next;
}

FitOptions simulation_options(const SearchContext& context, bool thorough) {
  FitOptions options;
  options.max_iterations = thorough ? kIterations : kQuickIterations;
  options.tolerance = thorough ? kTolerance : 10.0 * kQuickTolerance;
  options.final_jacobian = thorough;
  options.cancel = context.options.cancel;
  return options;
}

double penalty_nats(const FitSummary& with, const FitSummary& without) {
  return kPerParameter_nats *
         static_cast<double>(with.parameters.size() - without.parameters.size());
}

std::vector<plant_sim::EffectInfo> absent_from(const SearchContext& context,
                                               const ModelStage& model) {
  std::vector<plant_sim::EffectInfo> effects;
  for (const plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    if (std::find(model.added.begin(), model.added.end(), effect.name) == model.added.end()) {
      effects.push_back(effect);
    }
  }
  return effects;
}

/// The most promising effects, fitted with the stage's gains.
std::vector<Trial> effect_trials(const InnovationStage& stage) {
  const SearchContext& context = stage.context;
  const double floor_m = context.problem.data.noise_floor_m;
  std::vector<ScreeningResult> screened =
      screen(context, stage.model, absent_from(context, stage.model));
  const double own = squares(stage.model.fitted, floor_m);
  std::erase_if(screened, [&](const ScreeningResult& result) {
    const double ratio = result.expected_ratio;
    return 0.5 * own * (1.0 - ratio * ratio) < kHopeless_nats;
  });
  screened.resize(std::min(screened.size(), kFitted));
  std::vector<Trial> trials(screened.size());
  const double before = own + prior_cost(stage.model.fitted);
  in_parallel(screened.size(), context.options.threads, [&](std::size_t i) {
    Trial& trial = trials[i];
    trial.candidate.effect = screened[i].effect;
    trial.candidate.gain_nats = -std::numeric_limits<double>::infinity();
    for (const VectorXd& start : screened[i].starts) {
      if (context.cancelled()) return;
      FitSummary fitted = fit_innovations(context, {screened[i].parameters, start}, Width{}, true);
      const double penalty = penalty_nats(fitted, stage.model.fitted);
      const double gain = 0.5 * (before - squares(fitted, floor_m) - prior_cost(fitted)) - penalty;
      if (!(gain > trial.candidate.gain_nats)) continue;
      trial.candidate.gain_nats = gain;
      trial.penalty_nats = penalty;
      trial.starts = {with_effect(stage.model, screened[i].effect, std::move(fitted))};
    }
  });
  return trials;
}

/// Further starts for the most promising effects of a simulation with the weak observer: the
/// stage's gains may be those that hide an effect, above all friction that sticks.
void add_simulated_starts(const SearchContext& plain, const InnovationStage& stage,
                          std::vector<Trial>& trials) {
  ModelStage simulated = stage.model;
  ParameterSubset all = subset(stage.model.fitted, [](const auto&) { return true; });
  simulated.fitted = fit(plain.problem.model, plain.problem.data, plain.problem.data.training_mask,
                         all.parameters, all.start, simulation_options(plain, true));
  std::vector<ScreeningResult> screened = screen(plain, simulated, absent_from(plain, simulated));
  screened.resize(std::min(screened.size(), kSimulated));
  std::vector<FitSummary> fits(screened.size());
  in_parallel(screened.size(), plain.options.threads, [&](std::size_t i) {
    fits[i] = refine(plain, screened[i], simulation_options(plain, false)).fitted;
  });
  std::vector<std::size_t> order(fits.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return fits[a].training_rms_m < fits[b].training_rms_m;
  });
  for (std::size_t k = 0; k < std::min(kSimulatedStarts, order.size()); ++k) {
    FitSummary& fitted = fits[order[k]];
    const std::string& effect = screened[order[k]].effect;
    if (!(fitted.training_rms_m < kWorthSimulating * simulated.fitted.training_rms_m)) break;
    auto trial = std::find_if(trials.begin(), trials.end(),
                              [&](const Trial& known) { return known.candidate.effect == effect; });
    if (trial == trials.end()) {
      trials.emplace_back();
      trial = trials.end() - 1;
      trial->candidate.effect = effect;
      trial->penalty_nats = penalty_nats(fitted, stage.model.fitted);
    }
    trial->starts.push_back(with_effect(stage.model, effect, std::move(fitted)));
    trial->simulated = true;
  }
}

void sort_by_gain(std::vector<Trial>& trials) {
  std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) {
    return a.candidate.gain_nats > b.candidate.gain_nats;
  });
}

/// Whether an effect wants to be larger than such an effect can be.
bool leaves_its_range(const ModelStage& with, const ModelStage& without) {
  const FitSummary& fitted = with.fitted;
  for (std::size_t i = without.fitted.parameters.size(); i < fitted.parameters.size(); ++i) {
    const FreeParameter& p = fitted.parameters[i];
    const bool is_angle = p.name.find(".phase_rad") != std::string::npos;
    const bool absent = fitted.theta[static_cast<Index>(i)] == 0.0;
    if (p.refinement == 0 && fitted.at_bound[i] != 0 && !absent && !is_angle) return true;
  }
  return false;
}

/// The best of a trial's starts with a noise model of its own.
InnovationStage settled(const SearchContext& plain, const InnovationStage& stage,
                        const Trial& trial) {
  NoiseModel noise = stage.noise;
  if (trial.candidate.effect.empty()) noise.lines.push_back(trial.candidate.line);
  InnovationStage best;
  for (const ModelStage& start : trial.starts) {
    InnovationStage one = settled(plain, start, noise, 1, Width{});
    if (one.minus_two_log < best.minus_two_log) best = std::move(one);
  }
  return best;
}

/// One round: false when nothing gains enough.
bool extend(const SearchContext& plain, InnovationStage& stage,
            std::vector<InnovationRound>& rounds) {
  std::vector<Trial> trials;
  if (stage.model.added.size() < kMostEffects) {
    trials = effect_trials(stage);
    add_simulated_starts(plain, stage, trials);
  }
  if (stage.noise.lines.size() < kMostLines) {
    std::vector<ScoredLine> lines = lines_of(plain, stage);
    for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 2); ++i) {
      Trial trial;
      trial.candidate.line = lines[i].line;
      trial.penalty_nats = kPerParameter_nats * kParametersOfLine;
      trial.candidate.gain_nats = lines[i].gain_nats - trial.penalty_nats;
      trial.starts = {stage.model};
      trials.push_back(std::move(trial));
    }
  }
  sort_by_gain(trials);
  std::vector<InnovationStage> stages(trials.size());
  SearchProgress progress;
  progress.round = static_cast<int>(rounds.size()) + 1;
  progress.by_innovations = true;
  progress.of = static_cast<int>(trials.size());
  std::mutex reporting;
  in_parallel(trials.size(), plain.options.threads, [&](std::size_t i) {
    Trial& trial = trials[i];
    const bool finalist = i < kFinalists && trial.candidate.gain_nats > 0.0;
    if (plain.cancelled() || (!finalist && !trial.simulated)) return;
    stages[i] = settled(plain, stage, trial);
    trial.candidate.gain_nats =
        0.5 * (stage.minus_two_log - stages[i].minus_two_log) - trial.penalty_nats;
    trial.candidate.settled = true;
    if (!plain.options.progress) return;
    const std::lock_guard lock(reporting);
    ++progress.done;
    progress.effect = trial.candidate.effect.empty() ? "a spectral line" : trial.candidate.effect;
    plain.options.progress(progress);
  });
  std::size_t chosen = trials.size();
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const Trial& trial = trials[i];
    if (!trial.candidate.settled || !(trial.candidate.gain_nats >= kEvidence_nats)) continue;
    if (leaves_its_range(stages[i].model, stage.model)) continue;
    if (chosen == trials.size() || trial.candidate.gain_nats > trials[chosen].candidate.gain_nats) {
      chosen = i;
    }
  }
  for (std::size_t i = 0; i < trials.size(); ++i) {
    trials[i].candidate.penalty_nats = trials[i].penalty_nats;
    if (trials[i].candidate.settled) trials[i].candidate.fitted = stages[i].model.fitted;
    trials[i].candidate.fitted.jacobian.resize(0, 0);
  }
  InnovationRound round{stage.model, {}};
  round.before.fitted.jacobian.resize(0, 0);
  if (chosen < trials.size()) round.candidates.push_back(trials[chosen].candidate);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (i != chosen) round.candidates.push_back(trials[i].candidate);
  }
  rounds.push_back(std::move(round));
  if (chosen == trials.size()) return false;
  InnovationStage polished = settled(plain, stages[chosen].model, stages[chosen].noise, kMostTurns,
                                     wide(plain.options.threads));
  stage = std::isfinite(polished.minus_two_log) ? std::move(polished) : std::move(stages[chosen]);
  return true;
}

ParameterSubset without_effect(const InnovationStage& stage, const std::string& effect) {
  return subset(stage.model.fitted, [&](const auto& p) { return !belongs_to(p, effect); });
}

/// The stage with other parameters in the place of an effect's, or none.
InnovationStage exchanged(const SearchContext& plain, const InnovationStage& stage,
                          const std::string& effect, const std::string& other,
                          const ParameterSubset& own) {
  ModelStage model;
  for (const std::string& name : stage.model.added) {
    if (name != effect) model.added.push_back(name);
  }
  ParameterSubset parameters = without_effect(stage, effect);
  if (!other.empty()) {
    model.added.push_back(other);
    append(parameters, own);
  }
  model.fitted.parameters = parameters.parameters;
  model.fitted.theta = parameters.start;
  model.fitted = fit_innovations(stage.context, parameters, wide(plain.options.threads), false);
  return settled(plain, std::move(model), stage.noise, 1, wide(plain.options.threads));
}

/// Effects whose absence costs less than they are worth.
void eliminate(const SearchContext& plain, InnovationStage& stage) {
  bool dropped = true;
  while (dropped && stage.model.added.size() > 1 && !plain.cancelled()) {
    dropped = false;
    for (const std::string& effect : std::vector<std::string>(stage.model.added)) {
      InnovationStage without = exchanged(plain, stage, effect, "", {});
      const double loss = 0.5 * (without.minus_two_log - stage.minus_two_log) -
                          penalty_nats(stage.model.fitted, without.model.fitted);
      if (loss >= kEvidence_nats) continue;
      stage = std::move(without);
      dropped = true;
      break;
    }
  }
}

/// For each effect found, those that explain the record about as well in its place.
std::vector<InnovationRivals> rivals_of(const SearchContext& plain, const InnovationStage& final,
                                        const InnovationStage& before) {
  std::vector<InnovationRivals> groups;
  for (const std::string& effect : final.model.added) {
    if (plain.cancelled()) break;
    const InnovationStage without = final.model.added.size() == 1 && final.noise.lines.empty()
                                        ? before
                                        : exchanged(plain, final, effect, "", {});
    std::vector<Trial> rivals = effect_trials(without);
    add_simulated_starts(plain, without, rivals);
    sort_by_gain(rivals);
    double best = -std::numeric_limits<double>::infinity();
    for (const Trial& rival : rivals) {
      if (rival.candidate.effect == effect) best = rival.candidate.gain_nats;
    }
    InnovationRivals group{{effect}, {final.model.fitted}};
    std::size_t tried = 0;
    for (const Trial& rival : rivals) {
      const std::string& name = rival.candidate.effect;
      const auto& added = final.model.added;
      if (std::find(added.begin(), added.end(), name) != added.end()) continue;
      const bool far =
          rival.candidate.gain_nats < best - kWorthSettling_nats || rival.candidate.gain_nats < 0.0;
      if ((far && !rival.simulated) || ++tried > kFinalists ||
          group.names.size() == kLargestGroup) {
        continue;
      }
      const InnovationStage other = settled(plain, without, rival);
      const double behind =
          0.5 * (other.minus_two_log - final.minus_two_log) +
          kPerParameter_nats * (static_cast<double>(other.model.fitted.parameters.size()) -
                                static_cast<double>(final.model.fitted.parameters.size()));
      if (behind < kRivals_nats && !leaves_its_range(other.model, without.model)) {
        group.names.push_back(name);
        group.explanations.push_back(other.model.fitted);
      }
    }
    if (group.names.size() > 1) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace

FitSummary simulated(const SearchContext& context, const FitSummary& fitted) {
  DatasetSimulation run(context.problem.model, context.problem.data, fitted.parameters);
  FitSummary result = fitted;
  result.jacobian.resize(0, 0);
  MatrixXd residual_m;
  run.residuals(fitted.theta, residual_m);
  result.residual_m = residual_m.col(0);
  result.training_rms_m = rms(result.residual_m, context.problem.data.training_mask);
  result.validation_rms_m = rms(result.residual_m, context.problem.data.validation_mask);
  return result;
}

InnovationSearch search_innovations(const SearchContext& with_holdouts, const ModelStage& first) {
  SearchContext context = with_holdouts;
  if (context.problem.data.has_holdouts()) {
    std::vector<Dataset>& records = context.problem.data.records;
    records.resize(context.problem.data.fitted_records);
    context.problem.data = fit_dataset(std::move(records), {});
  }
  InnovationSearch search;
  InnovationStage stage = settled(context, first, {}, kMostTurns, wide(context.options.threads));
  search.before = stage;
  if (!std::isfinite(stage.minus_two_log)) return search;  // cancelled before anything was known
  while (!context.cancelled() && extend(context, stage, search.rounds)) {
  }
  eliminate(context, stage);
  if (!stage.model.added.empty()) search.rivals = rivals_of(context, stage, search.before);
  const std::vector<CurveGain> curves =
      context.cancelled() ? std::vector<CurveGain>() : curve_gains(stage);
  if (!curves.empty()) search.curve_nats = curves.front().gain_nats;
  search.final = std::move(stage);
  return search;
}

}  // namespace estimator::greybox::selection
