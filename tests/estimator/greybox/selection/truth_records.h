// Records from the truth generator (tests/truth), which shares no code with the product, and the
// shipped model that knows nothing of what they hide.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "config/record/record.h"
#include "daemon/control/reference.h"
#include "estimator/greybox/selection/problem.h"
#include "plant_sim/model_file.h"
#include "tests/truth/case.h"
#include "tests/truth/rig.h"

namespace diagnose_test {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

inline plant_sim::ModelFile thesis() {
  return plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis.toml");
}

/// The data sheet of the truth generator's single rod.
inline plant_sim::ModelFile single_rod() {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/single_rod_cylinder.toml");
  *model.value("cap_area_m2") = 20e-4;
  *model.value("rod_side_area_m2") = 12e-4;
  *model.value("stroke_m") = 0.61;
  return model;
}

inline greybox::Dataset dataset_of(const truth::Record& truth) {
  config::record::Record record;
  record.name = "truth";
  record.sample_time_s = 0.005;
  record.t_s = truth.t_s;
  record.u_V = truth.u_V;
  record.y_m = truth.y_m;
  return greybox::dataset_of(record);
}

inline selection::SearchContext context_with(greybox::Dataset record) {
  return selection::SearchContext{
      selection::make_problem(thesis(), greybox::fit_dataset({std::move(record)}, {})), {}};
}

inline selection::SearchContext context_of(const std::string& spec, std::size_t seed = 1) {
  return context_with(dataset_of(truth::simulate(truth::parse_case(spec, seed))));
}

/// The case's plant in closed loop on a reference of the product.
inline truth::Record run(const truth::Case& of, const monitor::control::ReferenceConfig& config,
                         double duration_s) {
  const auto reference = monitor::control::make_reference(config);
  constexpr double kTs_s = 0.005;
  truth::Rig rig(truth::machine(of));
  std::mt19937 random(static_cast<unsigned>(of.seed));
  std::normal_distribution<double> noise_m(0.0, of.noise_m);
  truth::Record record;
  const auto samples = std::lround(duration_s / kTs_s);
  for (long k = 0; k < samples; ++k) {
    const double t_s = static_cast<double>(k) * kTs_s;
    const double read_m =
        of.encoder_m * std::round((rig.reading_m() + noise_m(random)) / of.encoder_m);
    const double asked_V = of.kp_V_per_m * (reference->at(t_s) - read_m);
    const double u_V =
        std::clamp(of.converter_V * std::round(asked_V / of.converter_V), -10.0, 10.0);
    record.t_s.push_back(t_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(read_m);
    rig.hold(u_V);
  }
  return record;
}

}  // namespace diagnose_test
