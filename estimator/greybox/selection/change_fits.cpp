#include "estimator/greybox/selection/change_fits.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "estimator/greybox/selection/innovation_trials.h"
#include "estimator/parallel.h"

namespace estimator::greybox::selection {
namespace {

/// Range and step, in samples, in which the time of a change is looked for about its fit.
constexpr double kScanned_s = 1.0;
constexpr double kScanStep = 4.0;
constexpr int kScans = 3;
/// Share of the record, from the time of a change on, in which other times are held against it, the
/// ratio of their distances, and the errors within which a time is looked for.
constexpr double kProfiled = 0.25;
constexpr double kProfileStep = 1.2;
constexpr double kThreeErrors = 3.0;
/// Lag behind the best with the stage's gains, and as a share of what that gains, that a noise
/// model of its own may make up for.
constexpr double kWorthSettling_nats = 60.0;
constexpr double kWorthSettling = 0.2;

/// A value of one parameter, and what a fit with it costs, -2 ln of its likelihood.
struct ScannedValue {
  double theta;
  double cost;
};

std::optional<Eigen::Index> row_of(const FitSummary& fitted, const std::string& name) {
  const auto at = std::find_if(fitted.parameters.begin(), fitted.parameters.end(),
                               [&](const FreeParameter& p) { return p.name == name; });
  if (at == fitted.parameters.end()) return {};
  return at - fitted.parameters.begin();
}

/// The costs of other values of a parameter, the other parameters held.
std::vector<ScannedValue> scanned(const SearchContext& context, const FitSummary& fitted,
                                  Eigen::Index row, const std::vector<double>& thetas) {
  constexpr std::size_t kLanes = ObserverSimulation::kLanes;
  const FitDataset& data = context.problem.data;
  const FreeParameter& parameter = fitted.parameters[static_cast<std::size_t>(row)];
  DatasetSimulation run(context.problem.model, data, fitted.parameters);
  std::vector<ScannedValue> values;
  Eigen::MatrixXd residuals_m;
  for (std::size_t from = 0; from < thetas.size() && !context.cancelled(); from += kLanes) {
    Eigen::MatrixXd points = fitted.theta.replicate(1, static_cast<Eigen::Index>(kLanes));
    const std::size_t lanes = std::min(kLanes, thetas.size() - from);
    for (std::size_t i = 0; i < lanes; ++i) {
      points(row, static_cast<Eigen::Index>(i)) =
          std::clamp(thetas[from + i], parameter.lower, parameter.upper);
    }
    run.residuals(points, residuals_m);
    for (std::size_t i = 0; i < lanes; ++i) {
      const auto lane = static_cast<Eigen::Index>(i);
      const double floor_m = data.noise_floor_m;
      values.push_back(
          {points(row, lane), residuals_m.col(lane).squaredNorm() / (floor_m * floor_m)});
    }
  }
  return values;
}

/// Sets the time of a change to the likeliest within kScanned_s, the other parameters held: the
/// likelihood has a minimum about every pause of the motion. False where it is that already.
bool scan_time(const SearchContext& context, const std::string& name, FitSummary& fitted) {
  const std::optional<Eigen::Index> row = row_of(fitted, name);
  if (!row) return false;
  const double unit_s = fitted.parameters[static_cast<std::size_t>(*row)].unit;
  const double step = kScanStep * context.problem.data.sample_time_s / unit_s;
  const double present = fitted.theta[*row];
  constexpr int kLeastSteps = static_cast<int>(ObserverSimulation::kLanes);
  const int half = std::max(kLeastSteps, static_cast<int>(kScanned_s / unit_s / step));
  std::vector<double> thetas{present};
  for (int i = -half; i <= half; ++i) {
    if (i != 0) thetas.push_back(present + step * i);
  }
  const std::vector<ScannedValue> values = scanned(context, fitted, *row, thetas);
  if (values.empty()) return false;
  fitted.theta[*row] =
      std::min_element(values.begin(), values.end(), [](const auto& a, const auto& b) {
        return a.cost < b.cost;
      })->theta;
  return fitted.theta[*row] != present;
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

double time_error_s(const InnovationStage& stage, const std::string& change) {
  const FitSummary& fitted = stage.model.fitted;
  const std::optional<Eigen::Index> row = row_of(fitted, change + ".at_s");
  if (!row) return 0.0;
  const FitDataset& data = stage.context.problem.data;
  const double unit_s = fitted.parameters[static_cast<std::size_t>(*row)].unit;
  const double farthest_s =
      kProfiled * static_cast<double>(data.records.front().size()) * data.sample_time_s;
  const double present = fitted.theta[*row];
  std::vector<double> thetas{present};
  double by_s = data.sample_time_s;
  while (by_s < farthest_s) {
    thetas.push_back(present - by_s / unit_s);
    thetas.push_back(present + by_s / unit_s);
    by_s *= kProfileStep;
  }
  double error_s = 0.0;
  const std::vector<ScannedValue> values = scanned(stage.context, fitted, *row, thetas);
  if (stage.context.cancelled()) return std::nan("");
  for (const ScannedValue& value : values) {
    const bool as_likely = value.cost < values.front().cost + kThreeErrors * kThreeErrors;
    if (as_likely) error_s = std::max(error_s, std::abs(value.theta - present) * unit_s);
  }
  return kProfileStep * error_s / kThreeErrors;
}

}  // namespace estimator::greybox::selection
