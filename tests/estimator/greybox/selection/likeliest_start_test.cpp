#include "estimator/greybox/selection/likeliest_start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "config/schema/document.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/problem.h"
#include "estimator/greybox/selection/resonance_or_line.h"
#include "tests/workbench/diagnose/two_masses.h"

namespace estimator::greybox::selection {
namespace {

constexpr two_masses::Rig kRig{.resonance_Hz = 17.0,
                               .at_load = true,
                               .sample_rate_Hz = 500.0,
                               .duration_s = 6.0,
                               .kp_V_per_m = 100.0,
                               .kd_V_s_per_m = 6.0};

SearchContext context_of(const two_masses::Rig& rig) {
  const plant_sim::ModelFile model = plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"axis\"\nplant = \"force_driven_axis\"\n[parameters]\n"
      "mass_kg = 30.0\ndamping_N_s_per_m = 120.0\ngain_N_per_V = 40.0\n"
      "[effects.second_mass]\nmass_ratio = 0.3\nresonance_Hz = 17.0\ndamping_ratio = 0.03\n"
      "sensor_ratio = 1.0\n",
      "axis"));
  config::record::Record record = two_masses::record(rig);
  record.name = "two masses";
  record.sample_time_s = 1.0 / rig.sample_rate_Hz;
  return {make_problem(model, fit_dataset({dataset_of(record)}, {})), {}};
}

LikeliestStart found(const SearchContext& context, const std::vector<double>& resonances_Hz) {
  std::vector<ParameterSubset> starts;
  for (const double resonance_Hz : resonances_Hz) {
    const FreeParameter* const tuned = [&]() -> const FreeParameter* {
      for (const FreeParameter& p : context.problem.plant_parameters) {
        if (p.name == "second_mass.resonance_Hz") return &p;
      }
      return nullptr;
    }();
    EXPECT_NE(tuned, nullptr);
    if (tuned == nullptr) return {};
    starts.push_back({{*tuned}, Eigen::VectorXd::Constant(1, tuned->to_theta(resonance_Hz))});
  }
  return likeliest_start(context, std::move(starts), {}, 1);
}

// The record's own resonance, though it is not the first, and the mass that its force acts on.
TEST(LikeliestStart, HasTheRecordsResonanceAndThePlaceOfItsForce) {
  for (const bool on_second : {false, true}) {
    two_masses::Rig rig = kRig;
    (on_second ? rig.second_disturbance_N : rig.driven_disturbance_N) = 2.0;
    const SearchContext context = context_of(rig);
    const LikeliestStart best = found(context, {21.0, 17.0, 14.0});
    ASSERT_EQ(best.start.start.size(), 1);
    EXPECT_NEAR(best.start.parameters.front().to_physical(best.start.start[0]), 17.0, 1e-6);
    EXPECT_EQ(best.noise.force_place, on_second ? 1.0 : 0.0);
    EXPECT_LT(best.minus_two_log, found(context, {21.0}).minus_two_log);
  }
}

// Parameters found with the force on one mass, and moved to the other.
TEST(ForcePlace, IsReconsideredOnceTheResonanceIsFound) {
  two_masses::Rig rig = kRig;
  rig.second_disturbance_N = 2.0;
  const SearchContext context = context_of(rig);
  disturbance::NoiseModel noise;
  noise.noise = {.disturbance_sd = 2.0, .corner_Hz = 2.0, .walk_m = 1e-8, .sensor_m = 2e-6};
  noise.force_place = 0.0;
  InnovationStage stage =
      settled(context, first_stage(context), noise, Settling::once, SimulationWidth{});
  ASSERT_EQ(stage.noise.force_place, 0.0);
  const double before = stage.minus_two_log;
  reconsider_second_mass(context, stage);
  EXPECT_EQ(stage.noise.force_place, 1.0);
  EXPECT_LT(stage.minus_two_log, before - 20.0);
  const double found = stage.minus_two_log;
  reconsider_second_mass(context, stage);
  EXPECT_EQ(stage.noise.force_place, 1.0);
  EXPECT_LE(stage.minus_two_log, found);
  EXPECT_GT(stage.minus_two_log, found - 1.0);
}

// At the resonance that was found, the plant as found and as its file has it.
TEST(LikeliestStart, SharesOfTheMassAreTriedForASecondMassAlone) {
  const SearchContext context = context_of(kRig);
  ModelStage with;
  with.fitted.parameters = context.problem.plant_parameters;
  with.fitted.theta = start_of(context.problem.model, with.fitted.parameters);
  std::size_t mass = 0;
  while (with.fitted.parameters[mass].name != "mass_kg") ++mass;
  const auto row = static_cast<Eigen::Index>(mass);
  with.fitted.theta[row] = with.fitted.parameters[mass].to_theta(45.0);
  std::set<double> masses_kg;
  std::set<double> shares;
  for (const ParameterSubset& start : mass_share_starts(context, with)) {
    ASSERT_EQ(start.parameters.size(), with.fitted.parameters.size());
    FitSummary at;
    at.parameters = start.parameters;
    at.theta = start.start;
    EXPECT_NEAR(at.value("second_mass.resonance_Hz"), 17.0, 1e-9);
    masses_kg.insert(std::round(at.value("mass_kg")));
    shares.insert(at.value("second_mass.mass_ratio"));
  }
  EXPECT_EQ(masses_kg, (std::set<double>{30.0, 45.0}));
  EXPECT_GT(shares.size(), 1U);

  ModelStage rigid;
  rigid.fitted.parameters = {with.fitted.parameters[mass]};
  rigid.fitted.theta = with.fitted.theta.segment(row, 1);
  EXPECT_TRUE(mass_share_starts(context, rigid).empty());
}

}  // namespace
}  // namespace estimator::greybox::selection
