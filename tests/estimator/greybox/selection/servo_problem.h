// Records of a servo that is no more than an integrator, y' = rate(u, y, t), with anything in it,
// and a workshop whose model is y' = 0.05 u. Cheap: for what does not depend on the plant.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "config/record/record.h"
#include "estimator/greybox/selection/parameter_subset.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/screening.h"
#include "plant_sim/model_file.h"

namespace diagnose_test {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

inline constexpr double kServoGain = 0.05;  ///< m/s per V

using Rate = std::function<double(double u_V, double y_m, double t_s)>;
using Reading = std::function<double(double y_m, double t_s)>;
/// The command of a sample; `level` is a number within +-1 that changes every 0.15 s.
using Command = std::function<double(double level, double y_m)>;

inline double plain_reading(double y_m, double /*t_s*/) { return y_m; }
inline double pulling_back(double level, double y_m) { return 1.5 * level - 8.0 * (y_m - 0.3); }

struct ServoRun {
  Rate rate_mps;
  Reading reading_m = plain_reading;
  Command command_V = pulling_back;
  int samples = 4000;
  double sample_time_s = 0.005;
  unsigned seed = 3;
};

/// In steps of 0.1 ms, with 2 um of noise and an encoder of 5 um.
inline greybox::Dataset servo_record(const ServoRun& run) {
  std::mt19937 random(run.seed);
  std::normal_distribution<double> noise_m(0.0, 2e-6);
  std::uniform_real_distribution<double> level(-1.0, 1.0);
  config::record::Record record;
  record.name = "servo";
  record.sample_time_s = run.sample_time_s;
  const long hold = std::max(1L, std::lround(0.15 / run.sample_time_s));
  const long steps = std::lround(run.sample_time_s / 1e-4);
  double y_m = 0.3;
  double now = 0.0;
  double u_V = 0.0;
  for (int k = 0; k < run.samples; ++k) {
    const double t_s = run.sample_time_s * k;
    if (k % hold == 0) {
      now = level(random);
      u_V = run.command_V(now, y_m);
    }
    record.t_s.push_back(t_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(5e-6 * std::round((run.reading_m(y_m, t_s) + noise_m(random)) / 5e-6));
    for (long i = 0; i < steps; ++i) {
      y_m += 1e-4 * run.rate_mps(u_V, y_m, t_s + 1e-4 * static_cast<double>(i));
    }
  }
  return greybox::dataset_of(record);
}

inline plant_sim::ModelFile servo_model() {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/velocity_servo.toml");
  *model.value("time_constant_s") = 0.0;
  return model;
}

inline selection::SearchContext servo_context(const ServoRun& run) {
  return selection::SearchContext{
      selection::make_problem(servo_model(), greybox::fit_dataset({servo_record(run)}, {})), {}};
}

/// y' = 0.05 (u + offset).
inline Rate with_offset(double offset_V) {
  return [=](double u_V, double, double) { return kServoGain * (u_V + offset_V); };
}

/// The same behind a dead band of the given half width.
inline Rate with_offset_and_band(double offset_V, double width_V) {
  return [=](double u_V, double, double) {
    const double v_V = u_V + offset_V;
    return kServoGain * (v_V - std::fmin(std::fmax(v_V, -width_V), width_V));
  };
}

/// `before` with effects of one parameter, which start at a value.
inline selection::ModelStage stage_with(
    const selection::SearchContext& context, const selection::ModelStage& before,
    const std::vector<std::pair<std::string, double>>& effects) {
  using namespace estimator::greybox::selection;
  ParameterSubset selection = subset(before.fitted, [](const auto&) { return true; });
  ModelStage stage = before;
  for (const auto& [name, value] : effects) {
    const auto info = std::find_if(context.problem.candidate_effects.begin(),
                                   context.problem.candidate_effects.end(),
                                   [&](const auto& absent) { return absent.name == name; });
    ParameterSubset own{greybox::effect_parameters(*info, 0), Eigen::VectorXd(1)};
    own.start[0] = own.parameters.front().to_theta(value);
    append(selection, own);
    stage.added.push_back(name);
  }
  stage.fitted = refit(context, selection, context.problem.data.training_mask);
  return stage;
}

}  // namespace diagnose_test
