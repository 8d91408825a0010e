#include "plant_sim/model_file.h"

#include <gtest/gtest.h>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "plant_sim/library.h"
#include "plant_sim/plant.h"

namespace plant_sim {
namespace {

ModelFile parse(const std::string& text) {
  return read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"test\"\nplant = \"hydraulic_actuator\"\n" + text, "test.toml"));
}

std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const config::schema::ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ModelFile, ReadsParametersInitialStateEffectsAndLoop) {
  ModelFile model = parse(
      "[parameters]\nmass_kg = 80.0\n[initial]\ny_m = 0.2\n[effects.friction]\ncoulomb_N = 120.0\n"
      "[loop]\nkp_V_per_m = 250.0\n");
  EXPECT_EQ(model.loop.kp_V_per_m, 250.0);
  auto plant = make_plant(model);
  EXPECT_EQ(plant->position_m(), 0.2);
  EXPECT_EQ(*plant->parameter("mass_kg"), 80.0);
  EXPECT_EQ(*plant->parameter("friction.coulomb_N"), 120.0);
  EXPECT_EQ(*plant->parameter("area_m2"), 6.33e-4);
  EXPECT_EQ(plant->parameter("friction.coulomb"), nullptr);
}

TEST(ModelFile, PrintsWhatItReadsBackTheSame) {
  ModelFile model = parse("[effects.deadband]\nhalf_width_V = 0.05\n");
  *model.value("supply_pressure_Pa") = 7.12345678901234e6;
  const std::string text = print_model(model);
  const ModelFile again = read_model(config::schema::Document::parse(text, "printed"));
  EXPECT_EQ(print_model(again), text);
  EXPECT_NE(text.find("[effects.deadband]"), std::string::npos);
  EXPECT_EQ(text.find("[effects.friction]"), std::string::npos);
  EXPECT_EQ(make_plant(again)->parameter_info("supply_pressure_Pa")->min, 0.0);
}

TEST(ModelFile, TakesAFurtherNameOfAnEffectAndPrintsTheLibrarys) {
  ModelFile model = parse("[effects.added_load]\nmass_kg = 12.0\n");
  EXPECT_EQ(*model.value("coupled_slaves.mass_kg"), 12.0);
  EXPECT_EQ(*model.value("added_load.mass_kg"), 12.0);
  EXPECT_EQ(*make_plant(model)->parameter("added_load.mass_kg"), 12.0);
  const std::string text = print_model(model);
  EXPECT_NE(text.find("[effects.coupled_slaves]\nmass_kg = 12.0"), std::string::npos);
  EXPECT_EQ(text.find("added_load"), std::string::npos);
  EXPECT_EQ(find_effect("added_load")->name, "coupled_slaves");
}

TEST(ModelFile, KeepsPriorsAndMotionAndSaysWhichValuesItStates) {
  const std::string text =
      "schema_version = 1\nname = \"a\"\nplant = \"force_driven_axis\"\nmotion = \"rotary\"\n"
      "[parameters]\nmass_kg = 0.5\n[priors]\nmass_kg = 0.0\ngain_N_per_V = 0.1\n";
  const auto document = config::schema::Document::parse(text, "a.toml");
  const ModelFile model = read_model(document);
  EXPECT_TRUE(model.rotary());
  EXPECT_EQ(model.uncertainty_ratio(0), 0.0);
  EXPECT_EQ(model.uncertainty_ratio(1), 1.0);  // the plant's own
  EXPECT_EQ(model.uncertainty_ratio(2), 0.1);
  const ModelFile again =
      read_model(config::schema::Document::parse(print_model(model), "printed"));
  EXPECT_EQ(print_model(again), print_model(model));
  EXPECT_NE(print_model(model).find("motion = \"rotary\""), std::string::npos);
  EXPECT_EQ(print_model(ModelFile()).find("motion"), std::string::npos);
  const ModelFile stated = stated_values(model, document);
  EXPECT_EQ(stated.parameters[0].value, 0.5);
  EXPECT_TRUE(std::isnan(stated.parameters[1].value));
}

TEST(ModelFile, RefusesAPriorOfAValueThatIsNotPositive) {
  const std::string cylinder =
      "schema_version = 1\nname = \"a\"\nplant = \"hydraulic_cylinder\"\n[parameters]\n";
  const auto refusal_of = [&](const std::string& rest) {
    try {
      (void)read_model(config::schema::Document::parse(cylinder + rest, "a.toml"));
    } catch (const config::schema::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal_of("return_pressure_Pa = 0.0\n[priors]\nreturn_pressure_Pa = 0.1\n"),
            "a.toml: [priors] return_pressure_Pa: is relative to return_pressure_Pa = 0, which no "
            "fit can free; allowed: no prior, 0, or a value above 0");
  EXPECT_NE(refusal_of("inclination_rad = -0.2\n[priors]\ninclination_rad = 0.1\n"), "");
  EXPECT_NE(refusal_of("[priors]\ninclination_rad = 0.1\n"), "");
  EXPECT_EQ(refusal_of("[priors]\ninclination_rad = 0.0\n"), "");
  EXPECT_EQ(refusal_of("inclination_rad = 0.2\n[priors]\ninclination_rad = 0.1\n"), "");
}

TEST(ModelFile, WritingToAnEffectsParameterAddsTheEffect) {
  ModelFile model;
  *model.value("coupled_slaves.mass_kg") = 20.0;
  EXPECT_NE(print_model(model).find("[effects.coupled_slaves]\nmass_kg = 20.0"), std::string::npos);
  EXPECT_EQ(model.value("coupled_slaves.nothing"), nullptr);
}

TEST(ModelFile, SaysWhatIsWrong) {
  EXPECT_NE(refusal("[parameters]\nmas_kg = 1.0\n").find("mass_kg"), std::string::npos);
  EXPECT_NE(refusal("[parameters]\nmass_kg = -1.0\n").find("out of range"), std::string::npos);
  EXPECT_NE(refusal("[parameters]\nmass_kg = \"x\"\n"), "");
  EXPECT_NE(refusal("[effects.frction]\ncoulomb_N = 1.0\n").find("friction"), std::string::npos);
  EXPECT_NE(refusal("[initial]\ny_m = 0.7\n").find("stroke"), std::string::npos);
  EXPECT_EQ(refusal("[initial]\ny_m = 0.6\n"), "");
  try {
    (void)read_model(config::schema::Document::parse(
        "schema_version = 1\nname = \"x\"\nplant = \"lathe\"\n", "x.toml"));
    ADD_FAILURE() << "a lathe is no plant";
  } catch (const config::schema::Error& error) {
    EXPECT_NE(std::string(error.what()).find("hydraulic_actuator"), std::string::npos);
  }
  EXPECT_THROW(load_model("/nowhere/model.toml"), config::schema::Error);
}

TEST(ModelFile, EveryShippedModelLoadsAndRuns) {
  for (const char* name : {"thesis", "thesis_calibrated", "rig_2000psi", "rig_2000psi_slaves",
                           "velocity_servo", "force_driven_axis"}) {
    const ModelFile model =
        load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/" + name + ".toml");
    EXPECT_EQ(model.name, name);
    auto plant = make_plant(model);
    const double from_m = plant->position_m();
    plant->advance(1.0, 0.1);
    EXPECT_GT(plant->position_m(), from_m) << name;
  }
}

TEST(ModelFile, RefusesAnEffectWhoseSiteThePlantLacks) {
  const auto text = [](const std::string& plant, const std::string& effect) {
    return "schema_version = 1\nname = \"x\"\nplant = \"" + plant + "\"\n[effects." + effect +
           "]\n";
  };
  const auto read = [](const std::string& toml) {
    return read_model(config::schema::Document::parse(toml, "x.toml"));
  };
  try {
    (void)read(text("velocity_servo", "supply_droop"));
    ADD_FAILURE() << "a velocity servo has no supply";
  } catch (const config::schema::ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "x.toml: [effects.supply_droop]: supply_droop acts on supply, which "
                 "velocity_servo does not have; allowed: effects of its sites command, amplifier, "
                 "set_speed, "
                 "lag, opening, "
                 "lap, sensor");
  }
  EXPECT_THROW((void)read(text("force_driven_axis", "deadband")), config::schema::Error);
  // slaves add mass and force: one of the two is not enough
  EXPECT_THROW((void)read(text("velocity_servo", "coupled_slaves")), config::schema::Error);
  EXPECT_NO_THROW((void)read(text("force_driven_axis", "coupled_slaves")));
  try {
    (void)read(text("velocity_servo", "second_mass"));
    ADD_FAILURE() << "nothing hangs on a servo whose command sets the speed";
  } catch (const config::schema::ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("its command sets the speed whatever it carries"),
              std::string::npos);
  }
  ModelFile model = read(text("velocity_servo", "null_bias"));
  EXPECT_EQ(make_plant(model)->parameter("supply_droop.droop_Pa_per_m3ps"), nullptr);
  *model.value("friction.coulomb_N") = 1.0;
  EXPECT_THROW((void)make_plant(model), config::schema::Error);
}

TEST(Library, ListsEveryEffectWithItsSitesAndUsableRanges) {
  ASSERT_FALSE(effect_library().empty());
  for (const EffectInfo& effect : effect_library()) {
    EXPECT_FALSE(effect.sites.empty()) << effect.name;
    for (const ParameterInfo& parameter : effect.parameters) {
      EXPECT_LE(parameter.min, parameter.neutral) << effect.name << parameter.name;
      EXPECT_LE(parameter.neutral, parameter.max) << effect.name << parameter.name;
      EXPECT_NE(parameter.typical, parameter.neutral) << effect.name << parameter.name;
    }
  }
}

}  // namespace
}  // namespace plant_sim
