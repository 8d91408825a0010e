#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <stdlib.h>
#include <CLI/Error.hpp>

#include <filesystem>
#include <fstream>

#include "config/schema/error.h"
#include "plant_sim/plant.h"
#include "tests/workbench/run_command.h"

namespace workbench::cli {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using workbench_test::run_command;

const std::string kModels = SPOOLWATCH_SOURCE_DIR "/config/models/";

class AddTest : public testing::Test {
 protected:
  AddTest() {
    std::string name = (fs::temp_directory_path() / "add-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
  }
  ~AddTest() override { fs::remove_all(folder_); }

  // The command's output; `arguments` without -o.
  std::string add(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"-o", out().string()});
    return workbench_test::printed_by(workbench::cli::add_add, std::move(arguments));
  }
  std::string refusal(std::vector<std::string> arguments, int exit_code = 78) const {
    arguments.insert(arguments.end(), {"-o", out().string()});
    try {
      run_command(workbench::cli::add_add, std::move(arguments));
    } catch (const config::schema::Error& error) {
      EXPECT_EQ(config::schema::exit_code_of(error), exit_code);
      EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
      EXPECT_TRUE(fs::is_empty(folder_));
      return error.what();
    }
    return "no refusal";
  }
  [[nodiscard]] fs::path out() const { return folder_ / "better.toml"; }

  fs::path folder_;
};

TEST_F(AddTest, WritesAModelThatHasTheEffect) {
  const std::string said =
      add({kModels + "thesis.toml", "friction", "coulomb_N=120", "static_N=1.5e2"});
  EXPECT_THAT(said, AllOf(HasSubstr("friction"), HasSubstr("coulomb_N = 120 N"),
                          Not(HasSubstr("no influence"))));
  auto plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("friction.coulomb_N"), 120.0);
  EXPECT_EQ(*plant->parameter("friction.static_N"), 150.0);
  EXPECT_EQ(*plant->parameter("friction.stribeck_mps"), 0.0);
  EXPECT_EQ(*plant->parameter("valve_gain_m_per_V"), 2.79e-5);
}

TEST_F(AddTest, KeepsWhatTheModelAlreadyHas) {
  add({kModels + "rig_2000psi_slaves.toml", "coupled_slaves", "needle_N_s2_per_m2=500"});
  auto plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("coupled_slaves.needle_N_s2_per_m2"), 500.0);
  EXPECT_EQ(*plant->parameter("coupled_slaves.mass_kg"), 20.0);
  EXPECT_EQ(*plant->parameter("friction.coulomb_N"), 300.0);
}

TEST_F(AddTest, TakesAddedLoadForCoupledSlaves) {
  EXPECT_THAT(add({kModels + "force_driven_axis.toml", "added_load", "mass_kg=7"}),
              HasSubstr("with coupled_slaves"));
  EXPECT_EQ(*plant_sim::load_model(out()).value("coupled_slaves.mass_kg"), 7.0);
}

TEST_F(AddTest, WritesOverItsOwnInputWholly) {
  fs::copy_file(kModels + "thesis.toml", out());
  add({out().string(), "flow_saturation", "limit_m3ps=3e-5"});
  add({out().string(), "null_bias", "offset_V=-0.1"});
  auto plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("flow_saturation.limit_m3ps"), 3e-5);
  EXPECT_EQ(*plant->parameter("null_bias.offset_V"), -0.1);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(AddTest, SaysWhichEffectsTheModelHasBeside) {
  EXPECT_THAT(add({kModels + "thesis.toml", "null_bias", "offset_V=-0.1"}),
              AllOf(HasSubstr("with null_bias\n"), Not(HasSubstr("beside"))));
  add({out().string(), "friction", "coulomb_N=50"});
  EXPECT_THAT(add({out().string(), "deadband", "half_width_V=0.1"}),
              HasSubstr("with deadband, beside null_bias, friction\n"));
  fs::remove(out());
  EXPECT_THAT(refusal({kModels + "thesis.toml", "deadband", "half_width_V=0.1", "friction"}, 2),
              HasSubstr("friction: is a second effect; allowed: parameter=number, and one effect"));
}

TEST_F(AddTest, SaysThatAnEffectWithoutValuesHasNoInfluenceYet) {
  EXPECT_THAT(add({kModels + "velocity_servo.toml", "transport_delay"}),
              HasSubstr("no influence until"));
  EXPECT_THAT(add({kModels + "thesis.toml", "spool_rate_limit"}), HasSubstr("rate_mps = inf m/s"));
  std::ifstream in(out());
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(text, HasSubstr("[effects.spool_rate_limit]\nrate_mps = inf"));
}

TEST_F(AddTest, AddsAndChangesAnEffectThatTheModelFileGivesAsAFormula) {
  const std::string model = kModels + "cubic_drag.toml";
  EXPECT_THAT(add({model, "cubic_drag", "drag_N_s3_per_m3=3e4"}),
              HasSubstr("drag_N_s3_per_m3 = 30000 N s3/m3"));
  auto plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("cubic_drag.drag_N_s3_per_m3"), 3e4);
  add({out().string(), "friction", "coulomb_N=50"});
  plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("cubic_drag.drag_N_s3_per_m3"), 3e4);
  EXPECT_EQ(*plant->parameter("friction.coulomb_N"), 50.0);
  fs::remove(out());
  EXPECT_THAT(refusal({model, "cubic_drag", "drag_N_s3_per_m3=-1"}), HasSubstr("out of range"));
  EXPECT_THAT(refusal({model, "cubicdrag"}), HasSubstr("did you mean cubic_drag?"));
  EXPECT_THAT(refusal({kModels + "thesis.toml", "cubic_drag"}), HasSubstr("is unknown"));
}

TEST_F(AddTest, NamesTheNearestForWhatItDoesNotKnow) {
  EXPECT_THAT(refusal({kModels + "thesis.toml", "fricton"}),
              AllOf(HasSubstr("did you mean friction?"), HasSubstr("backlash")));
  EXPECT_THAT(refusal({kModels + "thesis.toml", "friction", "colomb_N=1"}),
              AllOf(HasSubstr("did you mean coulomb_N?"), HasSubstr("direction_ratio")));
}

TEST_F(AddTest, RefusesBadValuesInOneLine) {
  const std::string model = kModels + "thesis.toml";
  EXPECT_THAT(refusal({model, "entrained_air", "fraction_ratio=0.9"}),
              HasSubstr("entrained_air.fraction_ratio: is 0.9, out of range; allowed: 0 to 0.5"));
  EXPECT_THAT(refusal({model, "null_bias", "offset_V=nan"}), HasSubstr("out of range"));
  EXPECT_THAT(refusal({model, "null_bias", "offset_V=1x"}, 2), HasSubstr("parameter=number"));
  EXPECT_THAT(refusal({model, "null_bias", "offset_V"}, 2), HasSubstr("parameter=number"));
  EXPECT_THAT(refusal({kModels + "force_driven_axis.toml", "deadband"}),
              HasSubstr("does not have; allowed: effects of its sites command, amplifier, drive"));
  EXPECT_THAT(refusal({"/nowhere/model.toml", "friction"}), HasSubstr("/nowhere/model.toml"));
}

TEST_F(AddTest, RefusesAParameterGivenTwice) {
  EXPECT_THAT(refusal({kModels + "thesis.toml", "friction", "coulomb_N=3", "coulomb_N=4"}, 2),
              HasSubstr("coulomb_N: is given twice"));
}

TEST_F(AddTest, WritesAFormulaWithItsBlock) {
  const std::string axis = kModels + "force_driven_axis.toml";
  EXPECT_THAT(add({axis, "--formula", "force: c*v_mps^3", "c=1e5"}), HasSubstr("with own_force"));
  auto plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("own_force.c"), 1e5);
  const plant_sim::ModelFile model = plant_sim::load_model(out());
  ASSERT_EQ(model.formula_effects.size(), 1U);
  EXPECT_EQ(model.formula_effects[0].formula, "c*v_mps^3");
  EXPECT_LT(model.formula_effects[0].parameters[0].min, 0.0);
  EXPECT_GT(model.formula_effects[0].parameters[0].max, 1e6);
  add({out().string(), "--formula", "command: u_V * (1 + a*abs(u_V))", "a=-0.01", "--name",
       "gain"});
  plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("gain.a"), -0.01);
  EXPECT_EQ(*plant->parameter("own_force.c"), 1e5);
}

TEST_F(AddTest, KeepsAWidthBelowAFractionBarAwayFromZero) {
  add({kModels + "force_driven_axis.toml", "--formula", "force: F_N * tanh(v_mps / w_mps)",
       "F_N=20", "w_mps=0.01"});
  const auto parameters = plant_sim::load_model(out()).formula_effects[0].parameters;
  EXPECT_EQ(parameters[0].neutral, 0.0);
  EXPECT_GT(parameters[1].min, 0.0);
  EXPECT_GT(parameters[1].max, 0.1);
}

TEST_F(AddTest, WritesAFormulaWithItsMemory) {
  add({kModels + "force_driven_axis.toml", "--formula", "command: u_V + k*z", "--memory",
       "(u_V - z)/lag_s", "k=0.3", "lag_s=0.1"});
  const auto effect = plant_sim::load_model(out()).formula_effects.at(0);
  EXPECT_EQ(effect.memory, "(u_V - z)/lag_s");
  EXPECT_EQ(effect.parameters[0].neutral, 0.0);
  EXPECT_GT(effect.parameters[1].min, 0.0);
  fs::remove(out());
  const std::string axis = kModels + "force_driven_axis.toml";
  EXPECT_THAT(refusal({axis, "--formula", "command: u_V + k*z", "k=1"}, 2),
              HasSubstr("unknown name z"));
  EXPECT_THAT(refusal({axis, "--formula", "command: u_V + k", "--memory", "u_V - z", "k=1"}, 2),
              HasSubstr("memory: is not in the formula"));
}

TEST_F(AddTest, RefusesAFormulaThatTheModelCannotHave) {
  const std::string axis = kModels + "force_driven_axis.toml";
  const auto said = [&](const std::string& formula, std::vector<std::string> values) {
    values.insert(values.begin(), {axis, "--formula", formula});
    return refusal(values, 2);
  };
  EXPECT_THAT(said("forc: c*v_mps", {"c=1"}), HasSubstr("did you mean force?; allowed: command"));
  EXPECT_THAT(said("opening: c*x_m", {"c=1"}), HasSubstr("force_driven_axis does not have"));
  EXPECT_THAT(said("force: c*w_mps", {"c=1"}), HasSubstr("unknown name w_mps"));
  EXPECT_THAT(said("force: c*k*v_mps", {"c=1"}), HasSubstr("parameters are given as NAME=NUMBER"));
  EXPECT_THAT(said("force: c*v_mps", {"c=1", "d=2"}), HasSubstr("d: is not in the formula"));
  EXPECT_THAT(said("force: c*v_mps", {"c=1", "c=2"}), HasSubstr("given twice"));
  EXPECT_THAT(said("force: c*v_mps", {"c=0"}), HasSubstr("above or below 0"));
  EXPECT_THAT(said("force: v_mps", {}), HasSubstr("has no parameter"));
  EXPECT_THAT(said("c*v_mps", {"c=1"}), HasSubstr("has no site"));
  EXPECT_THAT(said("force: c*(v_mps", {"c=1"}), HasSubstr("unclosed parenthesis"));
  EXPECT_THAT(said("force: 3 + c*v_mps", {"c=1"}), HasSubstr("has influence when"));
  EXPECT_THAT(said("force: c*v_mps", {"c=1", "--name", "friction"}), HasSubstr("library"));
  EXPECT_THAT(refusal({axis}, 2), HasSubstr("nothing to add"));
  EXPECT_THAT(refusal({axis, "friction", "--name", "own"}, 2), HasSubstr("--formula or --law"));
}

constexpr const char* kDiagnosis = R"({"laws": [{"name": "cubic_damping", "what": "drag",
  "site": "force", "variables": ["v"], "formula": "c * v_mps^3", "parameters": {"c": {
  "value": 812.5, "std_error": 2.0, "what": "size", "min": 0.0, "max": 1e6, "typical": 1e3,
  "neutral": 0.0}}}]})";

class AddLawTest : public AddTest {
 protected:
  AddLawTest() {
    std::string name = (fs::temp_directory_path() / "law-XXXXXX").string();
    given_ = ::mkdtemp(name.data());
    std::ofstream(diagnosis()) << kDiagnosis;
  }
  ~AddLawTest() override { fs::remove_all(given_); }
  [[nodiscard]] std::string diagnosis() const { return (given_ / "diagnosis.json").string(); }

  const std::string axis_ = kModels + "force_driven_axis.toml";
  fs::path given_;
};

TEST_F(AddLawTest, TakesACurveWithItsTable) {
  const auto value = [](const char* name, double at) {
    return "\"" + std::string(name) + "\": {\"value\": " + std::to_string(at) +
           R"(, "what": "", "min": -1e3, "max": 1e3, "typical": 10.0, "neutral": 0.0})";
  };
  std::ofstream(diagnosis())
      << R"json({"laws": [{"name": "force_over_v", "what": "", "site": "force", "variables": ["v"],
      "formula": "f(v_mps)", "parameters": {)json"
      << value("f1", -5.0) << ", " << value("f2", 0.0) << ", " << value("f3", 7.0)
      << R"json(}, "table": {"over": "v_mps", "times": "", "x": [-0.1, 0.0, 0.2]}}]})json";
  add({axis_, "--law", "1", "--from", diagnosis()});
  plant_sim::ModelFile model = plant_sim::load_model(out());
  ASSERT_TRUE(model.formula_effects.at(0).curve);
  EXPECT_THAT(model.formula_effects.at(0).curve->x, testing::ElementsAre(-0.1, 0.0, 0.2));
  EXPECT_EQ(*model.value("force_over_v.f3"), 7.0);
}

TEST_F(AddLawTest, TakesTheLawWithItsFittedValue) {
  const std::string said = add({axis_, "--law", "1", "--from", diagnosis()});
  EXPECT_THAT(said, HasSubstr("with cubic_damping"));
  EXPECT_THAT(said, HasSubstr("spoolwatch fit " + out().string() + " RECORD -o "));
  auto plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("cubic_damping.c"), 812.5);
  const auto declared = plant_sim::load_model(out()).formula_effects.at(0);
  EXPECT_EQ(declared.formula, "c * v_mps^3");
  EXPECT_EQ(declared.parameters[0].max, 1e6);
  add({axis_, "--law", "1", "--from", diagnosis(), "--name", "drag", "c=900"});
  plant = plant_sim::make_plant(plant_sim::load_model(out()));
  EXPECT_EQ(*plant->parameter("drag.c"), 900.0);
}

TEST_F(AddLawTest, RefusesLawsThatAreNotThere) {
  EXPECT_THAT(refusal({axis_, "--law", "2", "--from", diagnosis()}, 2), HasSubstr("1 to 1"));
  EXPECT_THAT(refusal({axis_, "--law", "1", "--from", axis_}, 65), HasSubstr("is no diagnosis"));
  EXPECT_THAT(refusal({axis_, "--law", "1", "--from", "/nowhere.json"}, 65), HasSubstr("read"));
  EXPECT_THAT(refusal({axis_, "--law", "1", "--from", diagnosis(), "d=1"}, 2),
              HasSubstr("d: is not in the formula"));
  EXPECT_THAT(refusal({axis_, "--law", "1", "--from", diagnosis(), "c=-1"}, 2),
              HasSubstr("out of range"));
  EXPECT_THAT(refusal({kModels + "velocity_servo.toml", "--law", "1", "--from", diagnosis()}, 2),
              HasSubstr("velocity_servo does not have"));
  std::ofstream(diagnosis()) << R"({"laws": [{"name": "cubic_damping"}]})";
  EXPECT_THAT(refusal({axis_, "--law", "1", "--from", diagnosis()}, 65), HasSubstr("complete"));
  EXPECT_THROW(run_command(workbench::cli::add_add, {axis_, "--law", "1", "-o", out().string()}),
               CLI::ParseError);
}

TEST_F(AddTest, LeavesNothingBehindWhenItCannotWrite) {
  try {
    run_command(workbench::cli::add_add,
                {kModels + "thesis.toml", "friction", "-o", "/nowhere/better.toml"});
    ADD_FAILURE() << "there is no such folder";
  } catch (const config::schema::RunError& error) {
  }
  EXPECT_THROW(run_command(workbench::cli::add_add, {kModels + "thesis.toml", "friction"}),
               CLI::ParseError);
}

}  // namespace
}  // namespace workbench::cli
