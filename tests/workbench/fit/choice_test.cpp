#include "workbench/fit/parameter_selection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "config/schema/error.h"

namespace workbench::fit {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string kModels = SPOOLWATCH_SOURCE_DIR "/config/models/";

std::vector<std::string> names(const FreeParameters& choice) {
  std::vector<std::string> out;
  for (const auto& p : choice.parameters) out.push_back(p.name);
  return out;
}

std::string refusal(const ParameterSelection& selection, int exit_code) {
  try {
    (void)select_parameters(plant_sim::load_model(kModels + "rig_2000psi.toml"), selection);
  } catch (const config::schema::Error& error) {
    EXPECT_EQ(config::schema::exit_code_of(error), exit_code) << error.what();
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    return error.what();
  }
  return "no refusal";
}

TEST(FitChoice, TakesTheUncertainOnesAndThoseOfTheEffects) {
  const auto model = plant_sim::load_model(kModels + "rig_2000psi.toml");
  EXPECT_THAT(
      names(select_parameters(model, {})),
      ElementsAre("mass_kg", "damping_N_s_per_m", "bulk_modulus_Pa", "dead_volume_m3",
                  "supply_pressure_Pa", "valve_gain_m_per_V", "valve_natural_frequency_rad_per_s",
                  "valve_damping_ratio", "friction.coulomb_N"));
}

TEST(FitChoice, FreesAndFixesByNameOrByEffect) {
  const auto model = plant_sim::load_model(kModels + "rig_2000psi.toml");
  EXPECT_THAT(names(select_parameters(model, {.free = {"area_m2,friction.coulomb_N", "mass_kg"}})),
              ElementsAre("area_m2", "friction.coulomb_N", "mass_kg"));
  EXPECT_THAT(
      names(select_parameters(model,
                              {.free = {"mass_kg", "friction"}, .fix = {"friction.static_N"}})),
      AllOf(testing::Contains("friction.coulomb_N"), Not(testing::Contains("friction.static_N"))));
  EXPECT_THAT(names(select_parameters(model, {.fix = {"friction,supply_pressure_Pa"}})),
              AllOf(Not(testing::Contains("friction.coulomb_N")),
                    Not(testing::Contains("supply_pressure_Pa"))));
}

TEST(FitChoice, ReadsPriorsAndBoundsInTheParametersUnit) {
  const auto model = plant_sim::load_model(kModels + "rig_2000psi.toml");
  const FreeParameters choice =
      select_parameters(model, {.free = {"mass_kg", "friction.coulomb_N"},
                                .priors = {"mass_kg=55+-11", "friction.coulomb_N=250+-10%"},
                                .bounds = {"mass_kg=40:", "friction.coulomb_N=100:400"}});
  const auto& mass = choice.parameters[0];
  EXPECT_NEAR(mass.to_physical(mass.prior_mean), 55.0, 1e-9);
  EXPECT_NEAR(mass.prior_sd, 0.2, 1e-12);  // a logarithm: relative
  EXPECT_NEAR(mass.to_physical(mass.lower), 40.0, 1e-9);
  const auto& friction = choice.parameters[1];
  EXPECT_NEAR(friction.to_physical(friction.prior_mean), 250.0, 1e-9);
  EXPECT_NEAR(friction.prior_sd * friction.slope(1.0), 25.0, 1e-9);
  EXPECT_NEAR(friction.to_physical(friction.lower), 100.0, 1e-9);
  EXPECT_NEAR(friction.to_physical(friction.upper), 400.0, 1e-9);
  EXPECT_NEAR(friction.to_physical(choice.start[1]), 300.0, 1e-9);
  EXPECT_TRUE(std::isinf(select_parameters(model, {.free = {"mass_kg"}, .priors = {"mass_kg=none"}})
                             .parameters[0]
                             .prior_sd));
}

TEST(FitChoice, RefusesInOneLineWithTheNearName) {
  EXPECT_THAT(refusal({.free = {"mas_kg"}}, 78), HasSubstr("did you mean mass_kg?"));
  EXPECT_THAT(refusal({.fix = {"friction.colomb_N"}}, 78),
              HasSubstr("did you mean friction.coulomb_N?"));
  EXPECT_THAT(refusal({.free = {"mass_kg"}, .priors = {"damping_N_s_per_m=1+-1"}}, 78),
              HasSubstr("is not fitted; name it with --free; allowed: mass_kg"));
  EXPECT_THAT(refusal({.priors = {"mass_kg=5"}}, 2), HasSubstr("name=mean+-sd"));
  EXPECT_THAT(refusal({.priors = {"mass_kg=5+-0"}}, 2), HasSubstr("sd above 0"));
  EXPECT_THAT(refusal({.priors = {"mass_kg"}}, 2), HasSubstr("equals sign"));
  EXPECT_THAT(refusal({.priors = {"mass_kg=-5+-1"}}, 78), HasSubstr("out of range"));
  EXPECT_THAT(refusal({.bounds = {"mass_kg=5:4"}}, 2), HasSubstr("low below high"));
  EXPECT_THAT(refusal({.bounds = {"mass_kg=0:4"}}, 78), HasSubstr("wider than"));
  EXPECT_THAT(refusal({.free = {"mass_kg"}, .fix = {"mass_kg"}}, 2),
              HasSubstr("leave nothing to fit"));
}

}  // namespace
}  // namespace workbench::fit
