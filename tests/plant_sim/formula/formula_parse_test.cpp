// Formulas as text: what they evaluate to, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "config/schema/error.h"
#include "plant_sim/formula/recorder.h"
#include "tests/plant_sim/formula/formula_support.h"

namespace plant_sim::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// With variables x, y and parameter k.
double value(const std::string& text, double x, double y, double k) {
  const formula::ExpressionProgram program =
      formula::record_formula(text, {"x", "y"}, {"k"}, "here");
  formula::ExpressionEvaluator<double> run(view_of(program));
  run.set_parameters(&k);
  const formula::Signals<double> at{x, y};
  const double alone = run(at.data());

  formula::ExpressionEvaluator<Simd> lanes(view_of(program));
  Simd many = 0.25;
  many.set(5, k);
  lanes.set_parameters(&many);
  const formula::Signals<Simd> every{Simd(x), Simd(y)};
  const double among = lanes(every.data())[5];
  EXPECT_TRUE(among == alone || (std::isnan(among) && std::isnan(alone)) ||
              std::abs(among - alone) <= 1e-12 * std::abs(alone))
      << text;
  return alone;
}

TEST(Formula, FollowsThePrecedenceOfArithmetic) {
  const double x = 1.7, y = -0.6, k = 2.5;
  EXPECT_EQ(value("x - y - k", x, y, k), x - y - k);
  EXPECT_EQ(value("x + y*k/x", x, y, k), x + y * k / x);
  EXPECT_EQ(value("-x^2", x, y, k), -(x * x));
  EXPECT_EQ(value("(-x)^2", x, y, k), x * x);
  EXPECT_EQ(value("x*-3", x, y, k), x * -3.0);
  EXPECT_DOUBLE_EQ(value("x^2^3", x, y, k), std::pow(x, 8.0));
  EXPECT_DOUBLE_EQ(value("2^x", x, y, k), std::pow(2.0, x));
  EXPECT_DOUBLE_EQ(value("y^-3", x, y, k), 1.0 / (y * y * y));
  EXPECT_DOUBLE_EQ(value("x^0.5 + y^7", x, y, k), std::sqrt(x) + std::pow(y, 7.0));
  EXPECT_EQ(value("x < y || x >= 1 && y != 2", x, y, k), 1.0);
  EXPECT_EQ(value("(x < y || x >= 1) && y == 2", x, y, k), 0.0);
  EXPECT_EQ(value("k", x, y, k), k);
  EXPECT_EQ(value("y", x, y, k), y);
  EXPECT_EQ(value("1.5e-3", x, y, k), 1.5e-3);
  EXPECT_EQ(value("+3 + k*k*2", x, y, k), 3.0 + k * k * 2.0);
}

TEST(Formula, HasThePowersOfTheMathLibrary) {
  EXPECT_EQ(value("2^3", 0.0, 0.0, 0.0), 8.0);
  EXPECT_EQ(value("floor(4^2)", 0.0, 0.0, 0.0), 16.0);
  EXPECT_EQ(value("y^2^3", 0.0, -0.5, 0.0), 1.0 / 256.0);
  const auto power = [](double a, double b) { return value("x^y", a, b, 0.0); };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  for (const double a : {1e-300, 1e-3, 0.5, 1.0, 1.0001, 7.0, 1e300}) {
    for (const double b : {-2.0, -0.3, 0.0, 1.0, 1.5, 2.0}) {
      const double exact = std::pow(a, b);
      if (!std::isnormal(exact)) continue;
      const double units = 1.5 + 2.0 * std::abs(b * std::log(a));
      EXPECT_NEAR(power(a, b), exact, 2.3e-16 * units * exact) << a << " ^ " << b;
    }
  }
  for (const double a : {-kInfinite, -2.0, 0.0, kInfinite}) {
    for (const double b : {-kInfinite, -2.0, 0.0, 2.0, 3.0, kInfinite}) {
      EXPECT_EQ(power(a, b), std::pow(a, b)) << a << " ^ " << b;
    }
  }
  EXPECT_TRUE(std::isnan(power(-2.0, 0.5)));
  EXPECT_TRUE(std::isnan(power(std::nan(""), 2.0)));
  EXPECT_EQ(power(1.0, std::nan("")), 1.0);
}

TEST(Formula, HasTheFunctionsOfTheMathLibrary) {
  const double x = 0.37, y = -1.3, k = 0.8;
  const auto near = [](double a, double b) {
    EXPECT_NEAR(a, b, 4e-15 * std::max(1.0, std::abs(b)));
  };
  near(value("abs(y) + sign(y) + sqrt(x)", x, y, k), 1.3 - 1.0 + std::sqrt(x));
  near(value("exp(y) + ln(x) + log10(x)", x, y, k), std::exp(y) + std::log(x) + std::log10(x));
  near(value("sin(x)*cos(y)*tan(k)", x, y, k), std::sin(x) * std::cos(y) * std::tan(k));
  near(value("asin(x) + acos(x) + atan(y)", x, y, k), std::acos(0.0) + std::atan(y));
  near(value("sinh(x) + cosh(x)", x, y, k), std::exp(x));
  near(value("tanh(y) + floor(y)", x, y, k), std::tanh(y) - 2.0);
  near(value("atan2(x, y) + min(x, y) + max(x, y)", x, y, k), std::atan2(x, y) + y + x);
  near(value("sin(2*pi*x)", x, y, k), std::sin(2.0 * std::acos(-1.0) * x));
  near(value("if(x > y, k, -k) + if(0, 1, 2) + sign(0)", x, y, k), k + 2.0);
  EXPECT_EQ(value("if(x > 0, 1/x, 5)", 0.0, y, k), 5.0);  // the side not taken may be infinite
  EXPECT_TRUE(std::isinf(value("1/x", 0.0, y, k)));
  EXPECT_TRUE(std::isnan(value("sqrt(y)", x, y, k)));
}

TEST(Formula, FindsWhatDependsOnParametersAloneOnce) {
  const formula::ExpressionProgram program =
      formula::record_formula("exp(k)*sqrt(k)*x + exp(k)*2*pi", {"x"}, {"k", "unused"}, "");
  EXPECT_EQ(program.moving.size(), 1U);  // times x, plus
  EXPECT_EQ(program.constants.size(), 2U);
  EXPECT_EQ(program.uses, (std::vector<bool>{true, false}));
}

TEST(Formula, JoinsOperationsInPairsWithoutAnotherResult) {
  const auto moving = [](const std::string& text) {
    return formula::record_formula(text, {"x", "y"}, {"k"}, "").moving.size();
  };
  EXPECT_EQ(moving("x*y + k"), 1U);
  EXPECT_EQ(moving("k + x*y"), 1U);
  EXPECT_EQ(moving("max(min(x, 1), 0)"), 1U);
  EXPECT_EQ(moving("(x*y + k)*(x*y)"), 3U);  // the product is used twice
  const double x = 0.1;
  const double y = 0.7;
  const double k = -0.07;  // x y + k cancels: one rounding less would show
  const double product = x * y;
  EXPECT_EQ(value("x*y + k", x, y, k), product + k);
  EXPECT_EQ(value("max(min(x + 3*k, 1), 0)", x, y, k), 0.0);
  EXPECT_EQ(value("max(min(x + y, k), y)", x, y, k), y);
}

/// The refusal of a force whose formula this is.
std::string refused(const std::string& formula) {
  return refusal_of(plant_text("hydraulic_actuator") + own_text("force", formula));
}

TEST(Formula, IsRefusedWithPositionAndTokenWhenItDoesNotParse) {
  const std::string at = "own.toml: [formula_effects.own] formula: ";
  EXPECT_EQ(refused("k*vmps"), at + "unknown name vmps at character 3, did you mean v_mps?; "
                                    "allowed: u_V, y_m, v_mps, x_m, in_Pa, out_Pa, a_mps2, k, "
                                    "pi, if, abs, sign, sqrt, exp, ln, log10, sin, cos, tan, "
                                    "asin, acos, atan, sinh, cosh, tanh, floor, atan2, min, max");
  EXPECT_EQ(refused("k*(v_mps"),
            at + "does not parse at character 9, near \")\": unclosed parenthesis");
  EXPECT_EQ(refused("k*v_mps)"),
            at + "does not parse at character 8, near \")\": unexpected parenthesis");
  EXPECT_EQ(refused("k*"), at + "does not parse at character 3: unexpected end");
  EXPECT_EQ(refused("k v_mps"),
            at + "does not parse at character 3, near \"v_mps\": an operator is missing before it");
  EXPECT_EQ(refused("k = v_mps"),
            at + "an assignment at character 3; allowed: one expression; == compares");
  EXPECT_EQ(refused("v_mps > 0 ? k : -k"),
            at + "unknown operator ? at character 11; allowed: if(condition, yes, no)");
  EXPECT_THAT(refused("k*abs(v_mps, 2)"), HasSubstr("too many arguments"));
  EXPECT_THAT(refused("k*if(v_mps, 2)"), HasSubstr("too few arguments"));
  EXPECT_THAT(refused("k*abs"), HasSubstr("abs at character 3 is a function and needs ("));
  EXPECT_THAT(refused("k*\"v\""), HasSubstr("a string at character 3"));
  EXPECT_THAT(refused("k, v_mps"), HasSubstr("has a comma outside of a function"));
  EXPECT_EQ(refused(""), at + "is empty");
  EXPECT_EQ(refused("  "), at + "is empty");
  EXPECT_THAT(refused("k # v_mps"), HasSubstr("does not parse at character 3"));
  std::string longer = "k";
  for (int i = 0; i < 2000; ++i) longer += " + v_mps^" + std::to_string(i) + "*k";
  EXPECT_THAT(refused(longer), HasSubstr("the expression is too long"));
  EXPECT_EQ(refused("k*v_mps"), "");
}

TEST(Formula, SurvivesAnyText) {
  const std::string pieces[] = {"k",  "v_mps", "(",  ")", "+", "-",  "*",    "/",   "^", ",",
                                "if", "min",   "pi", "3", "=", "&&", "\xff", "1e9", "!", " "};
  std::uint32_t random = 7;
  for (int run = 0; run < 3000; ++run) {
    std::string text;
    for (std::uint32_t n = random % 9 + 1; n > 0; --n) {
      random = random * 1664525U + 1013904223U;
      text += pieces[(random >> 16) % std::size(pieces)];
    }
    try {
      (void)formula::record_formula(text, {"v_mps"}, {"k"}, "here");
    } catch (const config::schema::ConfigError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << text;
    }
  }
}

TEST(Formula, IsRefusedWhenItActsThoughItsParametersAreNeutral) {
  const std::string at = "own.toml: [formula_effects.own] formula: has influence when its ";
  EXPECT_EQ(refused("(k + 1)*v_mps"), at + "parameters are neutral: -2 at v_mps = -2, k = 0; "
                                           "allowed: 0");
  EXPECT_THAT(refusal_of(plant_text("velocity_servo") + own_text("command", "k*u_V")),
              HasSubstr("neutral: 0 at u_V = -10, k = 0; allowed: u_V itself"));
  EXPECT_EQ(refusal_of(plant_text("velocity_servo") + own_text("command", "u_V + k")), "");
  EXPECT_EQ(refusal_of(plant_text("velocity_servo") + own_text("opening", "x_m*(1 + k)")), "");
}

TEST(Formula, IsRefusedWithThePlaceWhereItIsNotFinite) {
  const std::string at = "own.toml: [formula_effects.own] formula: is ";
  const std::string allowed =
      "; allowed: finite values: bound the parameters, or guard with max() or if()";
  EXPECT_EQ(refused("k/y_m"), at + "infinite at y_m = 0, k = 5e+05" + allowed);
  EXPECT_EQ(refused("k*sqrt(v_mps)"), at + "no number at v_mps = -2, k = 5e+05" + allowed);
  EXPECT_THAT(refused("v_mps/k - v_mps/k"), HasSubstr("k = 0"));
  EXPECT_THAT(refused("exp(k*v_mps) - 1"), HasSubstr("infinite at"));
  EXPECT_EQ(refused("k/max(y_m, 0.01)"), "");
  EXPECT_EQ(refused("k*sqrt(abs(v_mps))"), "");
  EXPECT_EQ(refused("k*sqrt(y_m)"), "");  // the stroke begins at 0
  EXPECT_THAT(refusal_of(plant_text("force_driven_axis") + own_text("force", "k*sqrt(y_m)")),
              HasSubstr("no number at y_m = -2"));  // an axis goes either way
}

TEST(Formula, ReadsTheSignalsThatThePlantHas) {
  EXPECT_EQ(refused("k*u_V*y_m*v_mps*x_m*(in_Pa - out_Pa)*1e-9"), "");
  EXPECT_EQ(refused("k*a_mps2"), "");
  EXPECT_THAT(refused("k*q_m3ps"), HasSubstr("unknown name q_m3ps"));  // no orifice's flow
  EXPECT_THAT(refusal_of(plant_text("force_driven_axis") + own_text("force", "k*in_Pa")),
              HasSubstr("unknown name in_Pa"));
  EXPECT_THAT(refusal_of(plant_text("velocity_servo") + own_text("command", "u_V + k*in_Pa")),
              HasSubstr("unknown name in_Pa"));
  EXPECT_EQ(refusal_of(plant_text("velocity_servo") + own_text("sensor", "y_m + k*v_mps*x_m")), "");
  EXPECT_THAT(refusal_of(plant_text("hydraulic_actuator") + own_text("force", "k*z")),
              HasSubstr("unknown name z"));
}

TEST(Formula, IsRefusedWithAMemoryThatMakesNoSense) {
  const auto with_memory = [](const std::string& formula, const std::string& memory) {
    return refusal_of(plant_text("force_driven_axis") +
                      "[formula_effects.own]\nsite = \"force\"\n" + "formula = \"" + formula +
                      "\"\nmemory = \"" + memory + "\"\n" +
                      parameter_text("k", "0.0", "100.0", "1.0", "0.0") +
                      parameter_text("tau_s", "0.01", "10.0", "1.0", "0.1"));
  };
  EXPECT_EQ(with_memory("k*z", "(abs(v_mps) - z)/tau_s"), "");
  EXPECT_THAT(with_memory("k*v_mps", "(abs(v_mps) - z)/tau_s"),
              HasSubstr("memory: is not in the formula"));
  EXPECT_THAT(with_memory("k*z", "(abs(v_mps) - zz)/tau_s"), HasSubstr("memory: unknown name zz"));
  EXPECT_THAT(with_memory("k*z", "(v_mps - z)/(tau_s - 1)"), HasSubstr("memory: is "));
  EXPECT_THAT(with_memory("k*z", "v_mps - z"), HasSubstr("parameters.tau_s: is not in the"));
}

TEST(Formula, IsRefusedWithADeclarationThatMakesNoSense) {
  const std::string plant = plant_text("hydraulic_actuator");
  const std::string own = own_text("force", "k*v_mps");
  EXPECT_THAT(refusal_of(plant + "[formula_effects.own]\nsite = \"force\"\nformula = \"v_mps\"\n"),
              HasSubstr("[formula_effects.own]: has no parameter"));
  EXPECT_THAT(refusal_of(plant + "[formula_effects.own]\nsite = \"supply\"\nformula = \"1\"\n"),
              AllOf(HasSubstr("site: is 'supply'"), HasSubstr("command, opening, flow, leakage")));
  EXPECT_THAT(refusal_of(plant + "[formula_effects.own]\nsite = \"force\"\n"),
              HasSubstr("[formula_effects.own] formula: is missing"));
  EXPECT_THAT(refusal_of(plant + "[formula_effects.friction]\nsite = \"force\"\nformula = \"k\"\n"
                                 "[formula_effects.friction.parameters.k]\nmin = 0\nmax = 1\n"
                                 "typical = 1\n"),
              HasSubstr("[formula_effects.friction]: has the name of an effect of the library"));
  EXPECT_THAT(refusal_of(plant + own + parameter_text("c", "0.0", "1.0", "1.0", "0.0")),
              HasSubstr("parameters.c: is not in the formula"));
  EXPECT_THAT(refusal_of(plant + own_text("force", "k*c") +
                         parameter_text("c", "0.0", "1.0", "1.0", "2.0")),
              HasSubstr("parameters.c neutral: is 2, out of range; allowed: 0 to 1"));
  EXPECT_THAT(refusal_of(plant + own_text("force", "k*c") +
                         parameter_text("c", "0.0", "1.0", "0.0", "0.0")),
              HasSubstr("typical: is the neutral value"));
  EXPECT_THAT(refusal_of(plant + own_text("force", "k*c") +
                         parameter_text("c", "0.0", "inf", "1.0", "0.0")),
              HasSubstr("out of range"));
  EXPECT_THAT(refusal_of(plant + own_text("force", "k*c") +
                         parameter_text("c", "1.0", "0.0", "1.0", "0.0")),
              HasSubstr("has no range"));
  EXPECT_THAT(refusal_of(plant + own_text("force", "k*sin") +
                         parameter_text("sin", "0.0", "1.0", "1.0", "0.0")),
              AllOf(HasSubstr("own.toml"), HasSubstr("sin")));
  EXPECT_THAT(refusal_of(plant + own + "[effects.own]\nk = -1.0\n"), HasSubstr("out of range"));
  EXPECT_THAT(refusal_of(plant + own + "[effects.own]\nkk = 1.0\n"), HasSubstr("did you mean k?"));
  EXPECT_THAT(refusal_of(plant + own + "[effects.owm]\nk = 1.0\n"), HasSubstr("did you mean own?"));
  EXPECT_THAT(refusal_of(plant_text("velocity_servo") + own),
              HasSubstr("own acts on force, which velocity_servo does not have"));
  EXPECT_THAT(refusal_of(plant + "formula_effects = 3\n"), HasSubstr("a table"));
  EXPECT_THAT(refusal_of(plant + "[formula_effects]\nown = 3\n"), HasSubstr("a table"));
  EXPECT_THAT(refusal_of(plant + "[formula_effects.\"a.b\"]\nsite = \"force\"\nformula = \"k\"\n"
                                 "[formula_effects.\"a.b\".parameters.k]\nmin = 0\nmax = 1\n"
                                 "typical = 1\n"),
              HasSubstr("is no name"));
}

}  // namespace
}  // namespace plant_sim::testing
