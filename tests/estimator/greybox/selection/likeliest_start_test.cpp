#include "estimator/greybox/selection/likeliest_start.h"

#include <gtest/gtest.h>

#include "config/schema/document.h"
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
  InnovationStage stage = settled(context, first_stage(context), noise, 1, SimulationWidth{});
  ASSERT_EQ(stage.noise.force_place, 0.0);
  const double before = stage.minus_two_log;
  reconsider_force_place(context, stage);
  EXPECT_EQ(stage.noise.force_place, 1.0);
  EXPECT_LT(stage.minus_two_log, before - 20.0);
  const double found = stage.minus_two_log;
  reconsider_force_place(context, stage);
  EXPECT_EQ(stage.noise.force_place, 1.0);
  EXPECT_EQ(stage.minus_two_log, found);
}

TEST(LikeliestStart, SharesOfTheMassAreTriedForASecondMassAlone) {
  const SearchContext context = context_of(kRig);
  const std::vector<FreeParameter>& all = context.problem.plant_parameters;
  const ParameterSubset with{all, start_of(context.problem.model, all)};
  const std::vector<ParameterSubset> starts = mass_share_starts(with);
  ASSERT_GT(starts.size(), 1U);
  for (const ParameterSubset& start : starts) {
    EXPECT_EQ(start.parameters.size(), all.size());
  }
  EXPECT_NE(starts.front().start, starts.back().start);
  EXPECT_TRUE(mass_share_starts({{all.front()}, with.start.head(1)}).empty());
}

}  // namespace
}  // namespace estimator::greybox::selection
