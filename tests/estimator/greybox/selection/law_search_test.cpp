// Laws of the dictionary: each can be simulated, and the one that a record hides is found.
#include "estimator/greybox/selection/law_search.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>

#include "estimator/greybox/selection/diagnosis.h"
#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/learned_laws.h"
#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using diagnose_test::kServoGain;
using diagnose_test::servo_context;
using diagnose_test::servo_record;
using diagnose_test::with_offset;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<std::string> names_of(const std::vector<Law>& laws) {
  std::vector<std::string> names;
  for (const Law& law : laws) names.push_back(law.effect.name);
  return names;
}

TEST(LawDictionary, EachLawCanBeDeclaredOnEachPlantThatHasItsSite) {
  const FitDataset data = fit_dataset({servo_record({.rate_mps = with_offset(0.0)})}, {});
  for (const plant_sim::PlantInfo& plant : plant_sim::plant_library()) {
    plant_sim::ModelFile model = plant_sim::load_model(
        std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/" +
        (plant.name == "hydraulic_actuator"   ? std::string("thesis")
         : plant.name == "hydraulic_cylinder" ? std::string("single_rod_cylinder")
                                              : plant.name) +
        ".toml");
    const std::vector<Law> laws = law_dictionary(model, data);
    EXPECT_FALSE(laws.empty()) << plant.name;
    for (const Law& law : laws) {
      EXPECT_NO_THROW(model.declare(law.effect, "test")) << plant.name << " " << law.effect.name;
      EXPECT_FALSE(law.variables.empty());
    }
    // a name that the model's own formula has is left alone
    EXPECT_THAT(names_of(law_dictionary(model, data)), IsEmpty());
  }
}

// Three digits of 0.3051 m do not tell places of a motion of 0.4 mm apart.
TEST(LawDictionary, PlacesOfASmallMotionFarFromZeroAreToldApart) {
  std::vector<double> u_V(2000);
  std::vector<double> y_m(2000);
  for (std::size_t k = 0; k < y_m.size(); ++k) {
    const double t_s = 0.005 * static_cast<double>(k);
    u_V[k] = std::cos(6.0 * t_s);
    y_m[k] = 0.3051 + 2e-4 * std::sin(6.0 * t_s);
  }
  const FitDataset data = fit_dataset({estimator::greybox::dataset_of(0.005, u_V, y_m)}, {});
  plant_sim::ModelFile model =
      plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis.toml");
  for (const Law& law : law_dictionary(model, data)) {
    EXPECT_NO_THROW(model.declare(law.effect, "test")) << law.effect.name;
    for (const auto& parameter : law.effect.parameters) {
      if (parameter.name != "rest_m") continue;
      EXPECT_NEAR(parameter.neutral, 0.3051, 1e-5);
      // a tenth of the motion's RMS of 0.14 mm
      EXPECT_NEAR(parameter.typical - parameter.neutral, 1.4e-5, 3e-6);
    }
  }
}

/// y' = 0.05 u (1 - 0.1 (u / 2 V)^2).
double curved_mps(double u_V, double /*y_m*/, double /*t_s*/) {
  return kServoGain * u_V * (1.0 - 0.1 * std::pow(u_V / 2.0, 2));
}

TEST(Laws, AGainThatCurvesIsLearnedWithItsSize) {
  const SearchContext context = servo_context({.rate_mps = curved_mps});
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::learned);
  ASSERT_THAT(names_of(d.laws), ElementsAre("gain_curvature"));
  EXPECT_THAT(d.established(), IsEmpty());
  EXPECT_THAT(d.laws.front().variables, Contains("u"));
  EXPECT_LT(d.rms_after_m, 1.15 * d.noise_floor_m);
  // the law in the better model: the rate at 2 V over that at 0
  plant_sim::ModelFile better = d.better;
  const double gain = *better.value("gain_mps_per_V");
  const double curvature = *better.value("gain_curvature.curvature_ratio");
  const std::string& formula = d.laws.front().effect.formula;
  const double full_mps = std::stod(formula.substr(formula.find("/ ") + 2));
  EXPECT_NEAR(gain, kServoGain, 1e-3 * kServoGain);
  EXPECT_NEAR(curvature * std::pow(2.0 * gain / full_mps, 2), -0.1, 0.003);
}

/// A search of the actuator's record that knows these effects of the library alone.
struct FewEffects {
  SearchContext context;
  InnovationSearch found;
};
FewEffects searched_with(const std::vector<std::string>& effects, const std::string& spec) {
  FewEffects result{diagnose_test::context_of(spec, 31), {}};
  SearchContext only = result.context;
  std::erase_if(only.problem.candidate_effects, [&](const plant_sim::EffectInfo& one) {
    return std::find(effects.begin(), effects.end(), one.name) == effects.end();
  });
  result.found = search_innovations(only, first_stage(only), {});
  return result;
}

TEST(Laws, ASearchEndsWhereItsLimitsSay) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=10,friction.coulomb_N=60,outside.force_N=10", 17);
  std::size_t asked = 0;
  SearchLimits limits;
  limits.ends_at = [&](const InnovationStage& stage, double) {
    ++asked;
    return stage.model.added.size() == 1;
  };
  const InnovationSearch found = search_innovations(context, first_stage(context), {}, limits);
  EXPECT_EQ(found.rounds.size(), asked);
  EXPECT_THAT(found.final.model.added, SizeIs(1));
  EXPECT_TRUE(found.without.empty());
  EXPECT_TRUE(found.ended_early);
}

// Left with the damping that stood beside an offset, a fit strays far above the model without both.
TEST(Laws, NoStageWithoutAnEffectIsLessLikelyThanTheModelWithoutAny) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=10,null_bias.offset_V=0.1,left_out=cubic_damping", 86);
  const std::optional<LawSearch> found =
      search_laws(context, first_stage(context), "", {"null_bias"}, LawChoice::beside_effects, 3);
  ASSERT_TRUE(found);
  const InnovationSearch& search = found->innovations;
  EXPECT_THAT(search.final.model.added,
              testing::UnorderedElementsAre("null_bias", "cubic_damping"));
  ASSERT_THAT(search.without, SizeIs(2));
  for (const InnovationStage& one : search.without)
    EXPECT_LT(one.minus_two_log, search.before.minus_two_log);
}

/// The stage with these effects alone, fitted to the record, and what an early law makes of it.
struct EarlyLaw {
  bool much = false;  ///< what they leave
  bool learned = false;
  Diagnosis diagnosis;
};
EarlyLaw early_law(const std::vector<std::string>& effects, const std::string& spec) {
  const FewEffects held = searched_with(effects, spec);
  const InnovationStage& stage = held.found.final;
  EXPECT_THAT(stage.model.added, testing::UnorderedElementsAreArray(effects));
  EarlyLaw result;
  result.much = leaves_much_physics(stage, held.found.inexact_nats);
  result.diagnosis.noise_floor_m = held.context.problem.data.noise_floor_m;
  result.learned =
      learn_law_early(held.context, first_stage(held.context), stage, {}, result.diagnosis);
  return result;
}

TEST(Laws, ALawIsLearnedEarlyWhereEffectsLeaveMuch) {
  const EarlyLaw cubic =
      early_law({"coupled_slaves"}, "motion=multisine,length_s=10,left_out=cubic_damping");
  EXPECT_TRUE(cubic.much);
  ASSERT_TRUE(cubic.learned);
  EXPECT_EQ(cubic.diagnosis.verdict, Verdict::learned);
  EXPECT_THAT(names_of(cubic.diagnosis.laws), ElementsAre("cubic_damping"));
  EXPECT_FALSE(cubic.diagnosis.where.empty());
}

TEST(Laws, NoLawIsLearnedEarlyWhereEffectsExplainTheRecord) {
  const EarlyLaw right =
      early_law({"null_bias", "quadratic_damping"},
                "motion=multisine,length_s=8,quadratic_damping.coefficient_N_s2_per_m2=18000,"
                "null_bias.offset_V=0.1");
  EXPECT_FALSE(right.much);
  EXPECT_FALSE(right.learned);
  EXPECT_EQ(right.diagnosis.verdict, Verdict::nothing_missing);
}

// A supply that droops in the place of the quadratic damping that is missing.
TEST(Laws, AModelIsClearlyLikelierOnlyWhereNoEffectAndNoOtherSearchComesNear) {
  const std::string damping =
      "motion=multisine,length_s=8,quadratic_damping.coefficient_N_s2_per_m2=40000";
  const FewEffects wrong = searched_with({"supply_droop"}, damping);
  const FewEffects right = searched_with({"quadratic_damping"}, damping);
  ASSERT_THAT(wrong.found.final.model.added, ElementsAre("supply_droop"));
  ASSERT_THAT(right.found.final.model.added, ElementsAre("quadratic_damping"));
  const InnovationStage stage =
      settled(wrong.context, first_stage(wrong.context), {}, Settling::once, {});
  EXPECT_FALSE(is_clearly_likelier(wrong.context, stage, stage, {}));
  EXPECT_FALSE(is_clearly_likelier(wrong.context, wrong.found.final, stage, {}));
  InnovationStage alone = stage;
  alone.context.problem.candidate_effects.clear();
  EXPECT_TRUE(is_clearly_likelier(wrong.context, wrong.found.final, alone, {}));
  EXPECT_FALSE(
      is_clearly_likelier(wrong.context, wrong.found.final, alone, right.found.final.model));
}

TEST(Laws, ALawCompetesWithTheEffectThatPassesForIt) {
  const FewEffects cubic =
      searched_with({"quadratic_damping"},
                    "motion=multisine,length_s=15,left_out=cubic_damping,outside.force_N=10");
  ASSERT_THAT(cubic.found.final.model.added, ElementsAre("quadratic_damping"));
  EXPECT_TRUE(law_competes(cubic.context, "force", cubic.found));
}

TEST(Laws, NoLawCompetesWithTheRightEffect) {
  const FewEffects quadratic =
      searched_with({"quadratic_damping"},
                    "motion=multisine,length_s=15,quadratic_damping.coefficient_N_s2_per_m2=18000,"
                    "outside.force_N=10");
  ASSERT_THAT(quadratic.found.final.model.added, ElementsAre("quadratic_damping"));
  EXPECT_FALSE(law_competes(quadratic.context, "force", quadratic.found));
  EXPECT_FALSE(law_competes(quadratic.context, "sensor", quadratic.found));
}

// A valve whose gain falls as it opens draws less, as from a supply that droops.
TEST(LongLaws, ALawOfTheOpeningCompetesWithAnEffectOfTheSupply) {
  const FewEffects curved =
      searched_with({"supply_droop"},
                    "motion=fast_steps,length_s=30,left_out=gain_curvature,left_out.size=0.05,"
                    "outside.force_N=20,outside.corner_Hz=3");
  ASSERT_THAT(curved.found.final.model.added, ElementsAre("supply_droop"));
  Diagnosis d;
  d.noise_floor_m = curved.context.problem.data.noise_floor_m;
  ASSERT_TRUE(prefer_law(curved.context, first_stage(curved.context), curved.found, d));
  EXPECT_THAT(names_of(d.laws), ElementsAre("gain_curvature"));
}

// Beside a disturbance no model leaves less than that.
TEST(LongLaws, ALawThatLeavesADisturbanceNeedNotLeaveLessThanWhatIsUnexplained) {
  const SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=15,left_out=cubic_damping,outside.force_N=30", 31);
  const ModelStage first = first_stage(context);
  Diagnosis unexplained;
  unexplained.noise_floor_m = context.problem.data.noise_floor_m;
  unexplained.search.final = first;
  unexplained.rms_after_m = 1.0;
  std::optional<LawSearch> near;
  Diagnosis learned = unexplained;
  ASSERT_TRUE(learn_laws(context, first, first, near, learned));
  ASSERT_TRUE(learned.disturbance);
  unexplained.rms_after_m = 0.99 * learned.rms_after_m;
  EXPECT_TRUE(learn_laws(context, first, first, near, unexplained));
  EXPECT_THAT(names_of(unexplained.laws), ElementsAre("cubic_damping"));
}

// A force one way and a gain that differs by direction pass for it together.
TEST(Laws, ALawIsLearnedInPlaceOfTwoEffectsElsewhere) {
  FewEffects two = searched_with(
      {},
      "motion=chirp,length_s=15,left_out=direction_damping,left_out.size=560,outside.force_N=5");
  two.found.final.model.added = {"load_force", "flow_asymmetry"};  // that explain nothing
  Diagnosis d;
  d.noise_floor_m = two.context.problem.data.noise_floor_m;
  ASSERT_TRUE(prefer_law(two.context, first_stage(two.context), two.found, d));
  EXPECT_THAT(names_of(d.laws), ElementsAre("direction_damping"));
  EXPECT_NEAR(*d.better.value("direction_damping.coefficient_N_s_per_m"), 560.0, 60.0);
}

TEST(Laws, AGainThatChangesAlongTheStrokeIsLearned) {
  const SearchContext context = servo_context({.rate_mps = [](double u_V, double y_m, double) {
    return kServoGain * u_V * (1.0 + 0.1 * y_m / 0.1);
  }});
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::learned);
  ASSERT_EQ(d.laws.size(), 1U);
  EXPECT_EQ(d.laws.front().effect.site, "opening");
  EXPECT_THAT(d.laws.front().variables, ElementsAre("y"));
  EXPECT_LT(d.rms_after_m, 1.15 * d.noise_floor_m);
}

TEST(Laws, LibraryEffectsBesideLawsKeepTheSizesOfTheRig) {
  SearchContext context = servo_context({.rate_mps = curved_mps});
  constexpr double kTypical = 12345.0;
  for (plant_sim::EffectInfo& effect : context.problem.candidate_effects) {
    if (effect.name == "null_bias") effect.parameters.front().typical = kTypical;
  }
  const std::optional<LawSearch> found =
      search_laws(context, first_stage(context), "", {"null_bias"}, LawChoice::unexplained,
                  kMostInnovationEffects);
  ASSERT_TRUE(found);
  const std::vector<plant_sim::EffectInfo>& candidates = found->context.problem.candidate_effects;
  const auto bias = std::find_if(candidates.begin(), candidates.end(),
                                 [](const auto& effect) { return effect.name == "null_bias"; });
  ASSERT_NE(bias, candidates.end());
  EXPECT_EQ(bias->parameters.front().typical, kTypical);
  EXPECT_TRUE(std::none_of(candidates.begin(), candidates.end(),
                           [](const auto& effect) { return effect.name == "deadband"; }));
}

TEST(Laws, AHealthyRecordTeachesNone) {
  const SearchContext context = servo_context({.rate_mps = with_offset(0.0)});
  const Diagnosis d = diagnose(context.problem, context.options);
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  EXPECT_THAT(d.laws, IsEmpty());
}

// A dead band in a log of means smooths to a curve, which follows the smoothing too.
TEST(LearnedLaws, ACurveInPlaceOfANameHasToLeaveMuchLessOfASlowLog) {
  Diagnosis named;
  named.noise_floor_m = 10e-6;
  named.rms_after_m = 20e-6;
  named.missing = {"deadband"};
  Diagnosis learned = named;
  learned.missing.clear();
  learned.laws.resize(1);
  learned.laws.front().effect.curve.emplace();
  learned.rms_after_m = 18e-6;
  EXPECT_GT(learned.rms_after_m, most_error_ratio(learned, named, true) * named.rms_after_m);
  EXPECT_LT(learned.rms_after_m, most_error_ratio(learned, named, false) * named.rms_after_m);
  learned.missing = named.missing;  // beside the name
  EXPECT_LT(learned.rms_after_m, most_error_ratio(learned, named, true) * named.rms_after_m);
  learned.missing.clear();
  learned.rms_after_m = named.noise_floor_m;  // explains the record
  EXPECT_EQ(most_error_ratio(learned, named, true), 1.0 - kRivals);
  learned.rms_after_m = 18e-6;
  learned.laws.front().effect.curve.reset();  // a formula
  EXPECT_LT(learned.rms_after_m, most_error_ratio(learned, named, true) * named.rms_after_m);
}

}  // namespace
}  // namespace estimator::greybox::selection
