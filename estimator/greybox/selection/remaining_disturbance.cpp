#include "estimator/greybox/selection/remaining_disturbance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/long_records.h"
#include "estimator/greybox/selection/noise_credibility.h"

namespace estimator::greybox::selection {

std::optional<RemainingDisturbance> remaining_disturbance(const plant_sim::ModelFile& model,
                                                          const Dataset& record,
                                                          const DiagnosisOptions& options) {
  SearchContext context;
  context.problem.model = model;
  context.problem.data = fit_dataset({record}, {});
  context.options = options;
  if (!std::isfinite(context.problem.data.noise_floor_m)) return {};
  context = for_search(context);
  ModelStage file;  // no free parameters
  file.fitted = simulated(context, {});
  InnovationStage stage = settled(context, file, {}, Settling::once, wide(options.threads));
  // lines take long to find, and no line follows the motion
  if (!std::isfinite(stage.minus_two_log) || leaves_much_physics(stage, 0.0)) return {};
  InnovationSearch search;
  search.before = stage;
  add_lines(context, search, stage);
  search.final = settled(context, stage.model, stage.noise, Settling::fully, wide(options.threads));
  if (!std::isfinite(search.final.minus_two_log)) return {};
  weigh_remainder(context, search);
  if (context.cancelled() || search.physics_missing()) return {};
  std::optional<Disturbance> found = disturbance_of(context, search);
  const double sensor_m = context.problem.data.noise_floor_m;
  const double rms_m = rms(file.fitted.residual_m, context.problem.data.all_mask);
  if (!found || !noise_is_credible(context, search, sensor_m, found, rms_m)) return {};
  add_line_rivals(context, search.final, *found);
  limit(*found, rms_m);
  const double floor_m = std::hypot(sensor_m, found->rms_m);
  return RemainingDisturbance{std::move(*found), floor_m};
}

}  // namespace estimator::greybox::selection
