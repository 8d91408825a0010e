#include "estimator/greybox/selection/change_fits.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// Range and step, in samples, in which the time of a change is looked for about its fit.
constexpr double kScanned_s = 1.0;
constexpr double kScanStep = 4.0;
constexpr int kScans = 3;
/// Lag behind the best with the stage's gains, and as a share of what that gains, that a noise
/// model of its own may make up for.
constexpr double kWorthSettling_nats = 60.0;
constexpr double kWorthSettling = 0.2;

/// Sets the time of a change to the likeliest within kScanned_s, the other parameters held: the
/// likelihood has a minimum about every pause of the motion. False where it is that already.
bool scan_time(const SearchContext& context, const std::string& name, FitSummary& fitted) {
  const auto at = std::find_if(fitted.parameters.begin(), fitted.parameters.end(),
                               [&](const FreeParameter& p) { return p.name == name; });
  if (at == fitted.parameters.end()) return false;
  const auto row = static_cast<Eigen::Index>(at - fitted.parameters.begin());
  const double step = kScanStep * context.problem.data.sample_time_s / at->unit;
  constexpr int kLanes = static_cast<int>(ObserverSimulation::kLanes);
  const auto half = std::max(kLanes, static_cast<int>(kScanned_s / at->unit / step));
  DatasetSimulation run(context.problem.model, context.problem.data, fitted.parameters);
  double least = rms(fitted.residual_m, context.problem.data.training_mask);
  double best = fitted.theta[row];
  Eigen::MatrixXd residuals_m;
  for (int from = -half; from <= half && !context.cancelled(); from += kLanes) {
    Eigen::MatrixXd points = fitted.theta.replicate(1, kLanes);
    for (int i = 0; i < kLanes; ++i) {
      points(row, i) =
          std::clamp(points(row, i) + step * std::min(from + i, half), at->lower, at->upper);
    }
    run.residuals(points, residuals_m);
    for (int i = 0; i < kLanes; ++i) {
      const double now = rms(residuals_m.col(i), context.problem.data.training_mask);
      if (now >= least) continue;
      least = now;
      best = points(row, i);
    }
  }
  const bool moved = best != fitted.theta[row];
  fitted.theta[row] = best;
  return moved;
}

/// A proposal fitted with the stage's gains.
InnovationStage tried(const ChangeProposal& proposal, const InnovationStage& stage,
                      SimulationWidth width) {
  SearchContext with_gains = stage.context;
  with_gains.problem.model = proposal.context.problem.model;
  ModelStage start = proposal.start;
  start.fitted = fit_innovations(with_gains, {start.fitted.parameters, start.fitted.theta}, width,
                                 InnovationFit::trial);
  if (scan_time(with_gains, name_of(proposal.score) + ".at_s", start.fitted)) {
    start.fitted = fit_innovations(with_gains, {start.fitted.parameters, start.fitted.theta}, width,
                                   InnovationFit::trial);
  }
  const double floor_m = stage.context.problem.data.noise_floor_m;
  const auto cost = [&](const FitSummary& fit) { return squares(fit, floor_m) + prior_cost(fit); };
  InnovationStage trial;
  trial.minus_two_log = stage.minus_two_log + cost(start.fitted) - cost(stage.model.fitted);
  trial.model = std::move(start);
  return trial;
}

}  // namespace

InnovationStage fitted(const ChangeProposal& proposal, const InnovationStage& stage,
                       SimulationWidth width) {
  return settled(proposal.context, tried(proposal, stage, width).model, stage.noise, Settling::once,
                 width);
}

std::vector<InnovationStage> fit_all(const std::vector<ChangeProposal>& proposals,
                                     const InnovationStage& stage, unsigned threads) {
  std::vector<InnovationStage> stages(proposals.size());
  in_parallel(proposals.size(), threads,
              [&](std::size_t i) { stages[i] = tried(proposals[i], stage, SimulationWidth{}); });
  std::vector<char> has_noise_model(stages.size(), 0);
  // with noise models of their own those that seemed the best may end behind others
  for (bool more = true; more;) {
    double best = penalised(stage);
    for (const InnovationStage& trial : stages) best = std::min(best, penalised(trial));
    const double behind_nats =
        std::max(kWorthSettling_nats, kWorthSettling * 0.5 * (penalised(stage) - best));
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < stages.size(); ++i) {
      if (has_noise_model[i] == 0 && penalised(stages[i]) < best + 2.0 * behind_nats)
        near.push_back(i);
    }
    in_parallel(near.size(), threads, [&](std::size_t k) {
      const std::size_t i = near[k];
      stages[i] = settled(proposals[i].context, std::move(stages[i].model), stage.noise,
                          Settling::once, SimulationWidth{});
      has_noise_model[i] = 1;
    });
    more = !near.empty();
  }
  if (std::none_of(stages.begin(), stages.end(),
                   [](const auto& one) { return std::isfinite(one.minus_two_log); })) {
    return {};
  }
  return stages;
}

InnovationStage polished(const ChangeProposal& taken, const InnovationStage& found,
                         SimulationWidth width) {
  InnovationStage stage = settled(taken.context, found.model, found.noise, Settling::fully, width);
  if (!(stage.minus_two_log < found.minus_two_log)) stage = found;
  for (int turn = 0; turn < kScans; ++turn) {
    ModelStage moved = stage.model;
    if (!scan_time(stage.context, name_of(taken.score) + ".at_s", moved.fitted)) break;
    InnovationStage other =
        settled(taken.context, std::move(moved), stage.noise, Settling::fully, width);
    if (!(other.minus_two_log < stage.minus_two_log)) break;
    stage = std::move(other);
  }
  return stage;
}

}  // namespace estimator::greybox::selection
