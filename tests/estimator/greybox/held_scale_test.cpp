#include "estimator/greybox/held_scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "config/schema/document.h"
#include "plant_sim/plant.h"

namespace estimator::greybox {
namespace {

using plant_sim::ModelFile;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kFactor = 1.25;

/// Each effect that has a force, a flow, a volume or a spool speed in its parameters.
constexpr const char* kEffects = R"(
[effects.friction]
coulomb_N = 100.0
static_N = 130.0
stribeck_mps = 0.01
presliding_stiffness_N_per_m = 1e6
presliding_damping_N_s_per_m = 300.0
[effects.quadratic_damping]
coefficient_N_s2_per_m2 = 4000.0
[effects.load_spring]
stiffness_N_per_m = 5000.0
rest_m = 0.2
[effects.load_force]
force_N = 300.0
[effects.force_ripple]
amplitude_N = 80.0
wavelength_m = 0.01
second_sin_N = 25.0
second_cos_N = 15.0
[effects.coupled_slaves]
mass_kg = 20.0
damping_N_s_per_m = 200.0
needle_N_s2_per_m2 = 1000.0
)";
constexpr const char* kFlowEffects = R"(
[effects.internal_leakage]
conductance_m3ps_per_Pa = 3e-12
[effects.external_leakage]
conductance_m3ps_per_Pa = 2e-12
[effects.supply_droop]
droop_Pa_per_m3ps = 5e9
[effects.underlap]
half_width_V = 0.1
)";

ModelFile model(const std::string& plant, const std::string& rest) {
  return plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"a\"\nplant = \"" + plant + "\"\n" + rest, "a.toml"));
}

std::vector<ModelFile> models() {
  const std::string flows = kFlowEffects;
  return {
      model("force_driven_axis", kEffects),
      model("hydraulic_actuator", kEffects + flows +
                                      "[effects.flow_saturation]\nlimit_m3ps = 1.2e-4\n"
                                      "[effects.spool_rate_limit]\nrate_mps = 4e-3\n"
                                      "[parameters]\nretracted_cushion_length_m = 0.4\n"
                                      "extended_cushion_length_m = 0.4\n"),
      model("hydraulic_cylinder", kEffects + flows +
                                      "[effects.flow_saturation]\nlimit_m3ps = 2e-4\n"
                                      "[effects.spool_rate_limit]\nrate_mps = 0.008\n"
                                      "[parameters]\ninclination_rad = 0.4\n"
                                      "retracted_cushion_length_m = 0.3\n"
                                      "extended_cushion_length_m = 0.3\n"),
  };
}

std::vector<std::string> names_of(const ModelFile& model) {
  std::vector<std::string> names;
  for (const auto& p : model.parameters) names.push_back(p.name);
  for (const auto& effect : model.effects) {
    if (!effect.present) continue;
    for (const auto& p : effect.parameters) names.push_back(effect.name + "." + p.name);
  }
  return names;
}

std::vector<std::string> without(std::vector<std::string> names,
                                 const std::vector<std::string>& out) {
  std::erase_if(names, [&](const std::string& name) {
    return std::find(out.begin(), out.end(), name) != out.end();
  });
  return names;
}

void multiply(ModelFile& model, const std::vector<std::string>& names, double by) {
  for (const std::string& name : names) *model.value(name) *= by;
}

std::vector<double> positions(const ModelFile& model) {
  const std::unique_ptr<plant_sim::Plant> plant = plant_sim::make_plant(model);
  std::vector<double> out;
  for (int k = 0; k < 3000; ++k) {
    const double t = 1e-3 * k;
    plant->advance((t > 1.5 ? 6.0 : 3.0) * std::sin(9.0 * t) + 3.0 * std::sin(61.0 * t), 1e-3);
    out.push_back(plant->position_m());
  }
  return out;
}

double apart_m(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

std::vector<std::string> scale_of(const ModelFile& model) {
  if (model.plant == "force_driven_axis") return {"gain_N_per_V"};
  if (model.plant == "hydraulic_actuator") return {"area_m2"};
  return {"cap_area_m2", "rod_side_area_m2"};
}

TEST(HeldScale, NamesAllThatMustScaleForTheSameMotionAndNothingElse) {
  for (const ModelFile& before : models()) {
    const std::vector<double> y_m = positions(before);
    const HeldScale held = held_scale(before, without(names_of(before), scale_of(before)));
    std::vector<std::string> holding{held.parameter};
    holding.insert(holding.end(), held.also_held.begin(), held.also_held.end());
    EXPECT_EQ(holding, scale_of(before));
    ModelFile all = before;
    multiply(all, holding, kFactor);
    multiply(all, held.scaled, kFactor);
    multiply(all, held.inverse, 1.0 / kFactor);
    EXPECT_LT(apart_m(positions(all), y_m), 1e-9) << before.plant;
    for (const std::string& name : held.scaled) {
      ModelFile but_one = all;
      *but_one.value(name) /= kFactor;
      EXPECT_GT(apart_m(positions(but_one), y_m), 2e-8) << before.plant << " " << name;
    }
    for (const std::string& name : held.inverse) {
      ModelFile but_one = all;
      *but_one.value(name) *= kFactor;
      EXPECT_GT(apart_m(positions(but_one), y_m), 2e-8) << before.plant << " " << name;
    }
  }
}

TEST(HeldScale, IsSetByTheOtherAreaWhereOneIsFitted) {
  const ModelFile cylinder = model("hydraulic_cylinder", "");
  const HeldScale held = held_scale(cylinder, {"mass_kg", "cap_area_m2"});
  EXPECT_EQ(held.parameter, "rod_side_area_m2");
  EXPECT_THAT(held.also_held, ElementsAre());
  EXPECT_THAT(held.scaled, ElementsAre("mass_kg", "cap_area_m2"));
  EXPECT_EQ(held_scale(cylinder, {"mass_kg", "cap_area_m2", "rod_side_area_m2"}).parameter, "");
  EXPECT_EQ(held_scale(model("velocity_servo", ""), {"gain_mps_per_V"}).parameter, "");
}

TEST(HeldScale, IsASentenceWithBothAreasAndTheFallOfTheSupply) {
  const ModelFile cylinder = models().back();
  const std::string words =
      held_scale_words(cylinder, {"mass_kg", "rated_flow_m3ps", "supply_droop.droop_Pa_per_m3ps"});
  EXPECT_EQ(words,
            "cap_area_m2 and rod_side_area_m2 are held at 19.6 cm2 and 11.6 cm2: command and "
            "position show only ratios to them. If they are 10 % larger, so are mass_kg and "
            "rated_flow_m3ps, and 10 % smaller is supply_droop.droop_Pa_per_m3ps; their errors do "
            "not contain that.");
}

}  // namespace
}  // namespace estimator::greybox
