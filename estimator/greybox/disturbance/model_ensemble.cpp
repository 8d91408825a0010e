#include "estimator/greybox/disturbance/model_ensemble.h"

#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox::disturbance {

using plant_sim::Ensemble;

std::unique_ptr<Ensemble> model_ensemble(const plant_sim::ModelFile& model, double sample_time_s,
                                         const std::vector<FreeParameter>& parameters,
                                         const Eigen::VectorXd& theta) {
  std::unique_ptr<Ensemble> ensemble =
      plant_sim::make_ensemble(model, step_for(model, sample_time_s));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const auto index = ensemble->find(parameters[i].name);
    if (!index) continue;
    const double value = parameters[i].to_physical(theta[static_cast<Eigen::Index>(i)]);
    for (std::size_t lane = 0; lane < Ensemble::kLanes; ++lane) ensemble->set(*index, lane, value);
  }
  return ensemble;
}

}  // namespace estimator::greybox::disturbance
