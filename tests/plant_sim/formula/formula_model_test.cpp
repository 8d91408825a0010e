// Formula effects in model files: read, listed, changed, declared, printed back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/units/quantity.h"
#include "plant_sim/library.h"
#include "plant_sim/plant.h"
#include "tests/plant_sim/formula/formula_support.h"

namespace plant_sim::testing {
namespace {

const std::string kHead = plant_text("hydraulic_actuator");
const std::string kDrag =
    "[formula_effects.cubic_drag]\nsite = \"force\"\nformula = \"c_N_s3_per_m3*v_mps^3\"\n"
    "what = \"drag of the \\\"seals\\\"\"\n[formula_effects.cubic_drag.parameters.c_N_s3_per_m3]\n"
    "what = \"force per speed cubed\"\nmin = 0.0\nmax = 1e7\ntypical = 2.5e5\n";

TEST(FormulaModel, IsReadListedAndSimulatedLikeAnEffectOfTheLibrary) {
  ModelFile model = model_of(kHead + kDrag + "[effects.cubic_drag]\nc_N_s3_per_m3 = 1.5e5\n");
  const std::vector<EffectInfo> effects = effects_of(model);
  ASSERT_EQ(effects.size(), effect_library().size() + 1);
  ASSERT_EQ(model.effects.size(), effects.size());
  const EffectInfo& own = effects.back();
  EXPECT_EQ(own.name, "cubic_drag");
  EXPECT_EQ(own.equation, "F = c_N_s3_per_m3*v_mps^3");
  EXPECT_EQ(own.what, "drag of the \"seals\"");
  EXPECT_EQ(own.sites, std::vector<std::string>{"force"});
  ASSERT_EQ(own.parameters.size(), 1U);
  EXPECT_STREQ(own.parameters[0].name, "c_N_s3_per_m3");
  EXPECT_STREQ(own.parameters[0].what, "force per speed cubed");
  EXPECT_EQ(own.parameters[0].max, 1e7);
  EXPECT_EQ(own.parameters[0].typical, 2.5e5);
  EXPECT_EQ(own.parameters[0].neutral, 0.0);
  EXPECT_TRUE(model.effects.back().present);
  EXPECT_EQ(*model.value("cubic_drag.c_N_s3_per_m3"), 1.5e5);

  auto plant = make_plant(model);
  EXPECT_EQ(*plant->parameter("cubic_drag.c_N_s3_per_m3"), 1.5e5);
  EXPECT_EQ(plant->parameter_info("cubic_drag.c_N_s3_per_m3")->max, 1e7);
  EXPECT_THAT(plant->parameter_names(), ::testing::Contains("cubic_drag.c_N_s3_per_m3"));
}

TEST(FormulaModel, DeclaredOnlyItIsACandidateUntilAValueIsWritten) {
  ModelFile model = model_of(kHead + kDrag);
  EXPECT_FALSE(model.effects.back().present);
  auto plant = make_plant(model);
  auto reference = make_plant(model_of(kHead));
  plant->advance(5.0, 0.3);
  reference->advance(5.0, 0.3);
  EXPECT_EQ(plant->position_m(), reference->position_m());
  *plant->parameter("cubic_drag.c_N_s3_per_m3") = 1e9;  // acts as the largest allowed
  plant->advance(5.0, 0.3);
  EXPECT_EQ(*plant->parameter("cubic_drag.c_N_s3_per_m3"), 1e7);
  reference->advance(5.0, 0.3);
  EXPECT_LT(plant->position_m(), reference->position_m() - 1e-3);

  *model.value("cubic_drag.c_N_s3_per_m3") = 3.0;
  EXPECT_TRUE(model.effects.back().present);
  EXPECT_EQ(model.value("cubic_drag.nothing"), nullptr);
}

TEST(FormulaModel, PrintsWhatItReadsBackTheSame) {
  for (const std::string added : {"", "[effects.cubic_drag]\nc_N_s3_per_m3 = 1.5e5\n"}) {
    const std::string second =
        "[formula_effects.a_bias]\nsite = \"sensor\"\nformula = \"y_m + b_m*sin(w*y_m)\"\n"
        "[formula_effects.a_bias.parameters.w]\nmin = 1\nmax = 10\ntypical = 2\nneutral = 1.25\n"
        "[formula_effects.a_bias.parameters.b_m]\nmin = 0\nmax = 1\ntypical = 0.1\n";
    const ModelFile model =
        model_of(kHead + kDrag + second + added + "[effects.friction]\ncoulomb_N = 9.0\n");
    const std::string text = print_model(model);
    const ModelFile again = model_of(text);
    EXPECT_EQ(print_model(again), text);
    ASSERT_EQ(again.formula_effects.size(), 2U);
    EXPECT_EQ(again.formula_effects[0].name, "cubic_drag");  // not by the alphabet
    EXPECT_EQ(again.formula_effects[0].what, "drag of the \"seals\"");
    EXPECT_EQ(again.formula_effects[1].parameters[0].name, "w");
    EXPECT_EQ(again.formula_effects[1].parameters[0].neutral, 1.25);
    for (std::size_t i = 0; i < model.effects.size(); ++i) {
      EXPECT_EQ(again.effects[i].name, model.effects[i].name);
      EXPECT_EQ(again.effects[i].present, model.effects[i].present) << model.effects[i].name;
    }
  }
  EXPECT_EQ(print_model(model_of(kHead)).find("formula"), std::string::npos);
}

TEST(FormulaModel, CanBeDeclaredByAProgram) {
  ModelFile model;
  *model.value("friction.coulomb_N") = 7.0;
  formula::FormulaEffect drag{"drag", "force", "k*v_mps^3", "", {{"k", "", 0.0, 1e7, 1e5, 0.0}},
                              "",     {}};
  model.declare(drag, "here");
  *model.value("drag.k") = 2e4;
  EXPECT_EQ(*model.value("friction.coulomb_N"), 7.0);
  EXPECT_EQ(*make_plant(model)->parameter("drag.k"), 2e4);
  drag.formula = "c*v_mps^5";
  drag.parameters[0].name = "c";
  model.declare(drag, "here");  // in its place, and absent again
  EXPECT_EQ(model.formula_effects.size(), 1U);
  EXPECT_EQ(model.value("drag.k"), nullptr);
  EXPECT_FALSE(model.effects.back().present);
  drag.formula = "c*";
  EXPECT_THROW(model.declare(drag, "here"), config::schema::Error);
  EXPECT_EQ(model.formula_effects[0].formula, "c*v_mps^5");
}

TEST(FormulaModel, ShipsAnExampleThatActs) {
  const std::string folder = SPOOLWATCH_SOURCE_DIR "/config/models/";
  ModelFile model = load_model(folder + "cubic_drag.toml");
  auto with = make_plant(model);
  auto without = make_plant(load_model(folder + "thesis.toml"));
  with->advance(9.0, 0.5);
  without->advance(9.0, 0.5);
  EXPECT_LT(with->position_m(), without->position_m() - 1e-3);
}

TEST(Units, AreReadFromTheEndOfAName) {
  const std::pair<const char*, const char*> kNames[] = {{"conductance_m3ps_per_Pa", "m3/s/Pa"},
                                                        {"droop_Pa_per_m3ps", "Pa/(m3/s)"},
                                                        {"needle_N_s2_per_m2", "N s2/m2"},
                                                        {"damping_N_s_per_m", "N s/m"},
                                                        {"gain_mps_per_V", "m/s/V"},
                                                        {"density_kg_per_m3", "kg/m3"},
                                                        {"frequency_rad_per_s", "rad/s"},
                                                        {"limit_m3ps", "m3/s"},
                                                        {"area_m2", "m2"},
                                                        {"asymmetry_ratio", ""},
                                                        {"c_N_s3_per_m3", "N s3/m3"},
                                                        {"decay_per_m", "1/m"},
                                                        {"k", ""},
                                                        {"torque_N_m", "N m"},
                                                        {"V", ""},
                                                        {"half_width_V", "V"}};
  for (const auto& [name, unit] : kNames) EXPECT_EQ(config::units::unit_of(name), unit) << name;
}

}  // namespace
}  // namespace plant_sim::testing
