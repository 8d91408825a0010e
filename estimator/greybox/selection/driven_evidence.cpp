#include "estimator/greybox/selection/driven_evidence.h"

#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox::selection {
namespace {

/// Share of its gain that an effect must have in the motion that the command makes. A real effect
/// exceeds its gain there, because the other parameters, held, do not make up for its absence.
constexpr double kDriven = 0.1;
constexpr const char* kSecondMass = "second_mass";

/// Scaled innovations of a context's predictor on the readings of a model's free run.
Eigen::VectorXd innovations_of(SearchContext context, const FitSummary& predictor,
                               const ParameterSubset& model) {
  for (Dataset& record : context.problem.data.records) {
    Dataset plain = record;
    plain.innovations.reset();
    ObserverSimulation simulation(context.problem.model, plain, model.parameters, 0.0);
    Eigen::MatrixXd residuals_m;
    simulation.residuals(model.start, residuals_m);
    record.y_m = simulation.predicted().reading_m;
  }
  return simulated(context, predictor).residual_m;
}

}  // namespace

double driven_nats(const SearchContext& plain, const InnovationStage& stage,
                   const std::string& effect) {
  const ParameterSubset whole = subset(stage.model.fitted, [](const auto&) { return true; });
  const ParameterSubset rest =
      subset(stage.model.fitted, [&](const auto& p) { return !belongs_to(p, effect); });
  disturbance::NoiseModel noise;
  noise.noise = stage.noise.noise;
  if (effect != kSecondMass) noise.force_place = stage.noise.force_place;
  const auto linear = disturbance::linearise(plain.problem.model, plain.problem.data,
                                             rest.parameters, rest.start, noise.force_place);
  SearchContext context = plain;
  context.problem.data = disturbance::innovation_data(plain.problem.model, plain.problem.data,
                                                      rest.parameters, rest.start, linear, noise)
                             .data;
  FitSummary predictor;
  predictor.parameters = rest.parameters;
  predictor.theta = rest.start;
  const Eigen::VectorXd told =
      innovations_of(context, predictor, whole) - innovations_of(context, predictor, rest);
  const double floor_m = plain.problem.data.noise_floor_m;
  return 0.5 * told.squaredNorm() / (floor_m * floor_m);
}

bool is_driven(const SearchContext& plain, const InnovationStage& stage, const std::string& effect,
               double gain_nats) {
  return driven_nats(plain, stage, effect) >= kDriven * gain_nats;
}

}  // namespace estimator::greybox::selection
