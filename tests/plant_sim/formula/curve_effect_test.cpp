// Curves of model files: a table in the place of a formula.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "plant_sim/ensemble.h"
#include "plant_sim/library.h"
#include "plant_sim/plant.h"
#include "tests/plant_sim/formula/formula_support.h"

namespace plant_sim::testing {
namespace {

using ::testing::HasSubstr;

std::string curve_text(const std::string& site, const std::string& over, const std::string& x,
                       const std::string& f, const std::string& more = "") {
  return "[curve_effects.own]\nsite = \"" + site + "\"\nover = \"" + over + "\"\nx = [" + x +
         "]\nf = [" + f + "]\n" + more;
}

/// The curve over the position as a reading shows it, less the position.
double at(const ModelFile& model, double y_m) {
  auto plant = make_plant(model);
  plant->set_state(std::array<double, 1>{y_m});
  return plant->reading_m() - plant->position_m();
}

TEST(CurveEffect, PassesThroughItsPointsAndIsConstantBeyond) {
  const ModelFile model =
      model_of(plant_text("force_driven_axis") +
               curve_text("sensor", "y_m", "-1.0, 0.0, 0.5, 2.0", "0.3, 0.0, -0.2, 0.1"));
  EXPECT_NEAR(at(model, -1.0), 0.3, 1e-15);
  EXPECT_NEAR(at(model, 0.0), 0.0, 1e-15);
  EXPECT_NEAR(at(model, 0.5), -0.2, 1e-15);
  EXPECT_NEAR(at(model, 2.0), 0.1, 1e-15);
  EXPECT_NEAR(at(model, -7.0), 0.3, 1e-15);
  EXPECT_NEAR(at(model, 7.0), 0.1, 1e-15);
}

TEST(CurveEffect, IsTheParabolaOnWhichItsPointsLie) {
  const ModelFile model =
      model_of(plant_text("force_driven_axis") +
               curve_text("sensor", "y_m", "-2, -1, 0.2, 1, 3", "4, 1, 0.04, 1, 9"));
  for (double y_m = -1.0; y_m <= 1.0; y_m += 0.05) EXPECT_NEAR(at(model, y_m), y_m * y_m, 1e-14);
}

TEST(CurveEffect, DoesWhatTheFormulaOfTheSameLineDoes) {
  const std::string head = plant_text("hydraulic_actuator");
  struct Twin {
    std::string site, curve, formula, k;
  };
  const Twin twins[] = {
      {"force", curve_text("force", "v_mps", "-1.0, 0.0, 1.0", "-5000.0, 0.0, 5000.0"), "k*v_mps",
       "5000.0"},
      {"force",
       curve_text("force", "y_m", "0.0, 0.3, 1.0", "0.0, 6000.0, 20000.0", "times = \"v_mps\"\n"),
       "k*y_m*v_mps", "20000.0"},
      {"opening", curve_text("opening", "u_V", "-10.0, 10.0", "-1.0, 1.0", "times = \"x_m\"\n"),
       "x_m*(1 + k*u_V)", "0.1"},
      {"command", curve_text("command", "y_m", "0.0, 1.0", "0.0, 2.0"), "u_V + k*y_m", "2.0"},
  };
  for (const Twin& twin : twins) {
    const ModelFile model = model_of(head + twin.curve);
    auto curve = make_plant(model);
    auto formula = make_plant(model_of(head + own_text(twin.site, twin.formula, "0.0", "1e6") +
                                       "[effects.own]\nk = " + twin.k + "\n"));
    auto without = make_plant(model_of(head));
    auto lanes = make_ensemble(model, model.step_s);
    lanes->start(curve->reading_m());
    double influence_m = 0.0;
    for (int k = 0; k < 400; ++k) {
      const double u_V = 2.0 * std::sin(k * 0.05) - 0.2;
      for (const auto& plant : {&curve, &formula, &without}) (*plant)->advance(u_V, 0.005);
      Ensemble::Values all_V;
      all_V.fill(u_V);
      lanes->advance(all_V, 0.005);
      ASSERT_NEAR(curve->position_m(), formula->position_m(), 1e-11) << twin.formula;
      ASSERT_NEAR(lanes->reading_m()[3], curve->position_m(), 1e-11) << twin.formula;
      influence_m = std::max(influence_m, std::abs(formula->position_m() - without->position_m()));
    }
    EXPECT_GT(influence_m, 1e-5) << twin.formula;
  }
}

TEST(CurveEffect, IsWhatItsFormulaSays) {
  const ModelFile model = model_of(
      plant_text("force_driven_axis") +
      curve_text("sensor", "y_m", "-1.0, -0.2, 0.0, 0.5, 2.0", "0.3, -0.1, 0.0, -0.2, 0.1"));
  ModelFile as_formula = model_of(plant_text("force_driven_axis"));
  formula::FormulaEffect own = model.formula_effects.front();
  own.curve.reset();
  as_formula.declare(own, "test");
  for (const char* name : {"own.f1", "own.f2", "own.f4", "own.f5"})
    *as_formula.value(name) = *ModelFile(model).value(name);
  for (double y_m = -1.5; y_m < 2.5; y_m += 0.013)
    ASSERT_NEAR(at(model, y_m), at(as_formula, y_m), 1e-14) << y_m;
}

TEST(CurveEffect, EachOfManyLanesIsOnItsOwnPiece) {
  const ModelFile model =
      model_of(plant_text("velocity_servo") +
               curve_text("opening", "u_V", "-2.0, -1.0, -0.5, 0.0, 0.2, 1.0, 3.0",
                          "-0.03, 0.02, 0.01, 0.0, -0.02, 0.03, -0.01"));
  auto lanes = make_ensemble(model, model.step_s);
  lanes->start(0.0);
  std::vector<std::unique_ptr<Plant>> single;
  for (std::size_t i = 0; i < Ensemble::Values{}.size(); ++i) single.push_back(make_plant(model));
  for (int k = 0; k < 50; ++k) {
    Ensemble::Values u_V;
    for (std::size_t i = 0; i < single.size(); ++i) {
      u_V[i] = 3.5 * std::sin(0.1 * k + static_cast<double>(i));
      single[i]->advance(u_V[i], 0.005);
    }
    lanes->advance(u_V, 0.005);
    for (std::size_t i = 0; i < single.size(); ++i)
      ASSERT_EQ(lanes->reading_m()[i], single[i]->reading_m()) << "lane " << i;
  }
}

TEST(CurveEffect, IsPrintedAsItIsReadWithTheValuesThatItHasNow) {
  ModelFile model = model_of(
      plant_text("hydraulic_actuator") +
      curve_text("force", "v_mps", "-0.1, 0.0, 0.1", "-50.0, 0.0, 80.0", "what = \"seals\"\n") +
      "[formula_effects.bias]\nsite = \"command\"\nformula = \"u_V + k\"\n" +
      "[formula_effects.bias.parameters.k]\nmin = 0.0\nmax = 1.0\ntypical = 0.5\n" +
      "[effects.bias]\nk = 0.25\n");
  *model.value("own.f3") = 90.0;
  const std::string text = print_model(model);
  EXPECT_THAT(text, HasSubstr("f = [-50.0, 0.0, 90.0]"));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("[effects.own]")));
  ModelFile again = model_of(text);
  EXPECT_EQ(*again.value("own.f1"), -50.0);
  EXPECT_EQ(*again.value("own.f3"), 90.0);
  EXPECT_EQ(*again.value("bias.k"), 0.25);
  EXPECT_EQ(print_model(again), text);
  EXPECT_EQ(effects_of(again).back().equation, "F = f(v_mps)");
}

TEST(CurveEffect, IsRefusedWhenItsTableIsNoCurve) {
  const auto refused = [](const std::string& site, const std::string& over, const std::string& x,
                          const std::string& f) {
    return refusal_of(plant_text("force_driven_axis") + curve_text(site, over, x, f));
  };
  EXPECT_EQ(refused("force", "v_mps", "0.0, 1.0", "0.0, 1.0"), "");
  EXPECT_THAT(refused("force", "v_mps", "0.0, 1.0", "0.0"),
              HasSubstr("own.toml: [curve_effects.own] f: has 1 values; allowed: one for each"));
  EXPECT_THAT(refused("force", "v_mps", "0.0", "0.0"), HasSubstr("x: has 1 points"));
  EXPECT_THAT(refused("force", "v_mps", "", ""), HasSubstr("x: has 0 points"));
  EXPECT_THAT(refused("force", "v_mps", "0.0, 1.0, 1.0", "0.0, 1.0, 2.0"),
              HasSubstr("x: does not ascend"));
  EXPECT_THAT(
      refused("force", "vmps", "0.0, 1.0", "0.0, 1.0"),
      HasSubstr("[curve_effects.own] over: is no signal that it sees: vmps, did you mean v_mps?"));
  EXPECT_THAT(refused("force", "in_Pa", "0.0, 1.0", "0.0, 1.0"),
              HasSubstr("over: is no signal that it sees: in_Pa"));
  EXPECT_THAT(refused("opening", "x_m", "0.0, 1.0", "0.0, 1.0"), HasSubstr("does not have"));
}

}  // namespace
}  // namespace plant_sim::testing
