// Changes of a model in an ensemble: the same motion as the single plant's schedule makes.
#include "plant_sim/ensemble_schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "plant_sim/schedule.h"

namespace plant_sim {
namespace {

constexpr double kTs_s = 0.005;

/// Largest difference of the readings over 3 s of a moving rod.
double difference_m(const Change& change) {
  ModelFile model;
  const auto plant = make_plant(model);
  Schedule single({change}, *plant);
  model.changes = {change};
  const auto ensemble = make_ensemble(model, model.step_s);
  EnsembleSchedule schedule(model, *ensemble);
  schedule.begin(*ensemble);
  ensemble->start(plant->reading_m());
  double most_m = 0.0;
  for (int k = 0; k < 600; ++k) {
    const double t_s = kTs_s * k;
    const double u_V = 2.0 * std::sin(6.0 * t_s);
    single.advance(*plant, u_V, t_s, kTs_s);
    schedule.apply(*ensemble, t_s, kTs_s);
    Ensemble::Values values;
    values.fill(u_V);
    ensemble->advance(values, kTs_s);
    most_m = std::fmax(most_m, std::fabs(ensemble->reading_m()[3] - plant->reading_m()));
  }
  return most_m;
}

TEST(EnsembleSchedule, MovesTheRodAsTheScheduleOfTheSinglePlant) {
  const Change none{.parameter = "supply_pressure_Pa", .at_s = 9.0, .value = 5e6};
  EXPECT_LT(difference_m(none), 1e-12);
  Change step = none;
  step.at_s = 1.0;
  EXPECT_LT(difference_m(step), 1e-12);
  Change ramp = step;
  ramp.ramp_s = 1.0;
  // the single plant takes the value at the beginning of each step of 1 ms: 0.5 ms behind the mean,
  // 1e-4 of the pressure over a travel of some centimetres
  constexpr double kLag_m = 5e-6;
  EXPECT_LT(difference_m(ramp), kLag_m);
  Change warming = step;
  warming.time_constant_s = 0.5;
  EXPECT_LT(difference_m(warming), kLag_m);
  Change factor{.parameter = "damping_N_s_per_m", .at_s = 1.0, .factor = 3.0};
  EXPECT_LT(difference_m(factor), 1e-12);
}

TEST(EnsembleSchedule, AStepWithinASampleTakesItsShare) {
  ModelFile model;
  model.changes = {{.parameter = "mass_kg", .at_s = 0.0125, .value = 150.0}};
  const auto ensemble = make_ensemble(model, model.step_s);
  EnsembleSchedule schedule(model, *ensemble);
  const std::size_t mass = ensemble->find("mass_kg").value();
  schedule.begin(*ensemble);
  const double before_kg = ensemble->get(mass, 0);
  const auto at = [&](double t_s) {
    schedule.apply(*ensemble, t_s, kTs_s);
    return ensemble->get(mass, 5);
  };
  EXPECT_EQ(at(0.005), before_kg);
  EXPECT_NEAR(at(0.010), before_kg + 0.5 * (150.0 - before_kg), 1e-9);
  EXPECT_EQ(at(0.015), 150.0);
  schedule.end(*ensemble);
  EXPECT_EQ(ensemble->get(mass, 5), before_kg);
}

TEST(EnsembleSchedule, EachLaneMayHaveATimeOfItsOwn) {
  ModelFile model;
  model.changes = {{.parameter = "friction.coulomb_N", .at_s = 1.0, .value = 80.0}};
  const auto ensemble = make_ensemble(model, model.step_s);
  EnsembleSchedule schedule(model, *ensemble);
  const auto at = schedule.find("change.friction.coulomb_N.at_s");
  ASSERT_TRUE(at.has_value());
  EXPECT_FALSE(schedule.find("change.friction.coulomb_N.when").has_value());
  EXPECT_FALSE(schedule.find("change.mass_kg.at_s").has_value());
  EXPECT_FALSE(schedule.find("mass_kg").has_value());
  schedule.set(*at, 2, 3.0);
  schedule.begin(*ensemble);
  schedule.apply(*ensemble, 2.0, kTs_s);
  const std::size_t friction = ensemble->find("friction.coulomb_N").value();
  EXPECT_EQ(ensemble->get(friction, 1), 80.0);
  EXPECT_EQ(ensemble->get(friction, 2), 0.0);
}

ModelFile parsed(const std::string& changes) {
  return read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"m\"\nplant = \"hydraulic_actuator\"\n" + changes, "m.toml"));
}

TEST(ModelChanges, AreReadPrintedAndRefusedWhereTheyMakeNoSense) {
  const std::string step = "[[change]]\nparameter = \"mass_kg\"\nat_s = 2.0\n";
  const ModelFile model = parsed(step + "value = 60.0\n");
  ASSERT_EQ(model.changes.size(), 1U);
  const ModelFile again =
      read_model(config::schema::Document::parse(print_model(model), "printed"));
  ASSERT_EQ(again.changes.size(), 1U);
  EXPECT_EQ(again.changes.front().at_s, 2.0);
  EXPECT_EQ(again.changes.front().value, 60.0);
  EXPECT_THROW(parsed(step), config::schema::ConfigError);  // to what?
  EXPECT_THROW(parsed(step + "value = 60.0\nfactor = 2.0\n"), config::schema::ConfigError);
  EXPECT_THROW(parsed(step + "value = 60.0\n" + step + "value = 70.0\n"),
               config::schema::ConfigError);
  EXPECT_THROW(parsed("[[change]]\nparameter = \"mas_kg\"\nat_s = 2.0\nvalue = 60.0\n"),
               config::schema::ConfigError);
  const auto refused = [](const std::string& change) {
    try {
      (void)parsed("[[change]]\nat_s = 2.0\n" + change);
    } catch (const config::schema::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using testing::HasSubstr;
  EXPECT_THAT(refused("parameter = \"mass_kg\"\nvalue = -5.0\n"), HasSubstr("out of range"));
  EXPECT_THAT(refused("parameter = \"mass_kg\"\nfactor = 1e12\n"), HasSubstr("out of range"));
  EXPECT_THAT(refused("parameter = \"friction.coulomb_N\"\nfactor = 2.0\n"),
              HasSubstr("is a factor on an effect that the model lacks"));
  EXPECT_THAT(refused("parameter = \"friction.stribeck_mps\"\nfactor = 2.0\n"),
              HasSubstr("or an [effects.friction] to change"));
  EXPECT_THAT(refused("parameter = \"friction.coulomb_N\"\nfactor = 2.0\n"
                      "[effects.friction]\nstatic_N = 5.0\n"),
              HasSubstr("has a factor, and the parameter is 0"));
  EXPECT_EQ(refused("parameter = \"friction.static_N\"\nfactor = 2.0\n"
                    "[effects.friction]\nstatic_N = 5.0\n"),
            "");
  // the rod starts at 0.305 m
  EXPECT_THAT(refused("parameter = \"stroke_m\"\nvalue = 0.1\n"),
              HasSubstr("to 0.1 leaves the rod beyond the stroke; allowed: initial.y_m = 0.305"));
  EXPECT_THAT(refused("parameter = \"stroke_m\"\nfactor = 0.2\n"), HasSubstr("beyond the stroke"));
  EXPECT_EQ(refused("parameter = \"stroke_m\"\nvalue = 0.4\n"), "");
  EXPECT_THAT(
      refused("parameter = \"mass_kg\"\nvalue = 60.0\nramp_s = 1.0\ntime_constant_s = 1.0\n"),
      HasSubstr("both ramp_s and time_constant_s"));
  EXPECT_THAT(refused("parameter = \"initial.y_m\"\nvalue = 0.1\n"), HasSubstr("no parameter"));
  // a rig that runs has no record to which the time belongs
  EXPECT_THROW((void)make_plant(model), config::schema::ConfigError);
  EXPECT_NO_THROW((void)make_plant(without_changes(model)));
}

TEST(ModelChanges, KnowAParameterByItsFurtherName) {
  const std::string load =
      "[[change]]\nparameter = \"added_load.mass_kg\"\nat_s = 2.0\nvalue = 20.0\n";
  const ModelFile model = parsed(load);
  EXPECT_EQ(model.changes.front().parameter, "coupled_slaves.mass_kg");
  const auto ensemble = make_ensemble(model, model.step_s);
  EXPECT_NO_THROW(EnsembleSchedule(model, *ensemble));
  EXPECT_THROW(
      parsed(load +
             "[[change]]\nparameter = \"coupled_slaves.mass_kg\"\nat_s = 4.0\nvalue = 30.0\n"),
      config::schema::ConfigError);
}

TEST(ModelChanges, AreOfEffectsThatThePlantCanHave) {
  EXPECT_THROW(
      (void)read_model(config::schema::Document::parse(
          "schema_version = 1\nname = \"m\"\nplant = \"velocity_servo\"\n"
          "[[change]]\nparameter = \"internal_leakage.conductance_m3ps_per_Pa\"\nat_s = 2.0\n"
          "value = 1e-12\n",
          "m.toml")),
      config::schema::ConfigError);
}

}  // namespace
}  // namespace plant_sim
