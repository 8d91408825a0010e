#include "workbench/diagnose/experiment_design.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/estimator/greybox/selection/servo_problem.h"
#include "tests/estimator/greybox/selection/truth_records.h"
#include "workbench/diagnose/advice_words.h"

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The model with one effect added, fitted to the shop's record.
greybox::FitSummary fitted_with(const selection::SearchContext& context,
                                const std::string& effect) {
  std::vector<greybox::FreeParameter> parameters = context.problem.plant_parameters;
  const auto own = greybox::effect_parameters(*plant_sim::find_effect(effect), 0);
  parameters.insert(parameters.end(), own.begin(), own.end());
  greybox::FitSummary best;
  for (const double size : {-1.0, 1.0}) {
    Eigen::VectorXd start = greybox::start_of(context.problem.model, parameters);
    start[start.size() - 1] = size;
    greybox::FitSummary fitted =
        greybox::fit(context.problem.model, context.problem.data,
                     context.problem.data.training_mask, parameters, start);
    if (best.theta.size() == 0 || fitted.training_rms_m < best.training_rms_m)
      best = std::move(fitted);
  }
  return best;
}

class SineWithAsymmetricFlow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    of_ =
        new truth::Case(truth::parse_case("motion=sine,flow_asymmetry.asymmetry_ratio=0.0135", 5));
    context_ = new selection::SearchContext(
        diagnose_test::context_with(diagnose_test::dataset_of(truth::simulate(*of_))));
    rivals_ = new std::vector<greybox::FitSummary>{fitted_with(*context_, "flow_asymmetry"),
                                                   fitted_with(*context_, "load_force")};
    advice_ = new Advice(advise(*context_, *rivals_, {"flow_asymmetry", "load_force"}));
  }
  static void TearDownTestSuite() {
    delete advice_;
    delete rivals_;
    delete context_;
    delete of_;
  }
  static truth::Case* of_;
  static selection::SearchContext* context_;
  static std::vector<greybox::FitSummary>* rivals_;
  static Advice* advice_;
};
truth::Case* SineWithAsymmetricFlow::of_ = nullptr;
selection::SearchContext* SineWithAsymmetricFlow::context_ = nullptr;
std::vector<greybox::FitSummary>* SineWithAsymmetricFlow::rivals_ = nullptr;
Advice* SineWithAsymmetricFlow::advice_ = nullptr;

TEST_F(SineWithAsymmetricFlow, IsExplainedAsWellByALoad) {
  EXPECT_LT((*rivals_)[1].validation_rms_m, 1.05 * (*rivals_)[0].validation_rms_m);
}

TEST_F(SineWithAsymmetricFlow, GetsAMotionNamedInWordsWithNumbers) {
  EXPECT_TRUE(advice_->separates);
  EXPECT_GE(advice_->separation, kSeparates);
  EXPECT_THAT(advice_->words,
              AllOf(StartsWith("Run "), HasSubstr(advice_->motion.words), HasSubstr(" mm of "),
                    Not(HasSubstr("does not tell")),
                    HasSubstr("to take flow_asymmetry for load_force, or the reverse,"),
                    HasSubstr("times the noise")));
}

TEST_F(SineWithAsymmetricFlow, IsResolvedByTheAdvisedMotionOnTheTrueRig) {
  const selection::SearchContext again = diagnose_test::context_with(diagnose_test::dataset_of(
      diagnose_test::run(*of_, advice_->motion.reference, advice_->motion.duration_s)));
  const greybox::FitSummary right = fitted_with(again, "flow_asymmetry");
  const greybox::FitSummary wrong = fitted_with(again, "load_force");
  EXPECT_LT(right.validation_rms_m, 1.1 * again.problem.data.noise_floor_m);
  EXPECT_GT(wrong.validation_rms_m, 1.15 * right.validation_rms_m);
}

// As of a constant force and a spring so long that it is one.
TEST_F(SineWithAsymmetricFlow, IsToldFromRivalsThatAreOneEquation) {
  const Advice advice = advise(*context_, {(*rivals_)[0], (*rivals_)[1], (*rivals_)[1]},
                               {"flow_asymmetry", "load_force", "load_spring"});
  EXPECT_TRUE(advice.separates);
  EXPECT_THAT(advice.words, AllOf(HasSubstr("flow_asymmetry for load_force or load_spring,"),
                                  HasSubstr("does not tell load_force and load_spring apart")));
}

TEST_F(SineWithAsymmetricFlow, IsAskedForASensorWhereTwoExplanationsAreOneEquation) {
  const Advice advice =
      advise(*context_, {(*rivals_)[0], (*rivals_)[0]}, {"load_force", "friction"});
  EXPECT_FALSE(advice.separates);
  EXPECT_THAT(advice.words, AllOf(HasSubstr("load_force and friction"), HasSubstr("load cell"),
                                  Not(HasSubstr("Run "))));
}

TEST_F(SineWithAsymmetricFlow, LeavesTheStrokeToEveryMotionTried) {
  for (const TestMotion& motion : test_motions(context_->problem)) {
    EXPECT_GT(motion.reference.centre_m - motion.reference.amplitude_m, 0.0);
    EXPECT_LT(motion.reference.centre_m + motion.reference.amplitude_m, 0.61);
    EXPECT_LE(motion.reference.amplitude_m, 0.07);
    EXPECT_TRUE(simulated(context_->problem, context_->problem.model, motion, 1).has_value())
        << motion.words;
  }
}

TEST(AdviceToExcite, NamesAMotionAboutTheMiddleOfTheStrokeForARodAtRest) {
  config::record::Record record;
  record.name = "rest";
  record.sample_time_s = 0.005;
  for (int k = 0; k < 1000; ++k) {
    record.t_s.push_back(0.005 * k);
    record.u_V.push_back(0.0);
    record.y_m.push_back(0.1 + 5e-6 * ((k * k / 7) % 3));
  }
  const selection::SearchContext context = diagnose_test::context_with(greybox::dataset_of(record));
  EXPECT_THAT(advice_to_excite(context.problem),
              AllOf(HasSubstr("multisine"), HasSubstr("of 305 mm")));
}

TEST(AdviceForUnexplained, NamesVariableSensorAndFormula) {
  EXPECT_THAT(
      advice_for_unexplained({{"force", "speed", 0.97}, {"force", "v", 0.96}}),
      AllOf(HasSubstr("with the speed"), HasSubstr("like a force"), Not(HasSubstr("%")),
            HasSubstr("chamber pressures"), HasSubstr("v_mps"), HasSubstr("site = \"force\"")));
}

TEST(AdviceForUnexplained, OffersNoFormulaForWhatGoesWithTime) {
  EXPECT_THAT(
      advice_for_unexplained({{"gain", "time", 0.8}}),
      AllOf(HasSubstr("with time"), HasSubstr("supply pressure"), Not(HasSubstr("formula"))));
}

TEST(AdviceForUnexplained, StillSaysWhatToRecordWhenNothingWasFound) {
  EXPECT_THAT(advice_for_unexplained({}), HasSubstr("chamber pressures"));
}

TEST(AdviceForUnexplained, LeavesOutReadingsThatLeapFirst) {
  const auto reading_m = [](double y_m, double t_s) {
    const bool leaps = std::abs(t_s - 5.0) < 0.001 || std::abs(t_s - 12.5) < 0.001;
    return leaps ? y_m + 1.5 : y_m;
  };
  const selection::SearchContext context = diagnose_test::servo_context(
      {.rate_mps = diagnose_test::with_offset(0.0), .reading_m = reading_m});
  const AdvisedDiagnosis d = workbench::diagnose::diagnose(context.problem, {});
  EXPECT_EQ(d.diagnosis.verdict, selection::Verdict::unexplained);
  EXPECT_THAT(d.advice, HasSubstr("samples that leap"));
  EXPECT_THAT(d.advice, Not(HasSubstr("formula")));
}

TEST(Advice, ForAPlaceThatIsNotToldNamesWhatTellsEach) {
  const std::string text = advice_for_unexplained({{"measurement", "y", 0.83, {"gain", "force"}}});
  for (const char* measured : {"second sensor", "supply pressure", "chamber pressures"}) {
    EXPECT_THAT(text, HasSubstr(measured));
  }
  EXPECT_THAT(text, Not(HasSubstr("enters like")));
  EXPECT_THAT(text, Not(HasSubstr("formula")));
  const std::string axis =
      advice_for_unexplained({{"measurement", "speed", 0.79, {"lag"}}}, "velocity_servo");
  EXPECT_THAT(axis, HasSubstr("lag"));
  const std::string once =
      advice_for_unexplained({{"flow", "u", 0.9, {"gain"}}}, "force_driven_axis");
  EXPECT_EQ(once.find("current"), once.rfind("current")) << once;
  const std::string either =
      advice_for_unexplained({{"force", "y", 0.9, {"gain"}}}, "force_driven_axis");
  EXPECT_THAT(either, HasSubstr("record the motor's current."));
  EXPECT_THAT(either, Not(HasSubstr("load cell"))) << "a load cell does not show the gain";
}

TEST(Advice, NamesNoValveAndNoChambersWhereThePlantHasNone) {
  for (const char* enters : {"flow", "gain", "force", "measurement"}) {
    for (const char* variable : {"v", "u", "time"}) {
      const std::string text =
          advice_for_unexplained({{enters, variable, 0.9}}, "force_driven_axis") +
          advice_for_unexplained({{enters, variable, 0.9, {"lag"}}}, "force_driven_axis");
      for (const char* word : {"valve", "chamber", "spool", "oil", "opening"}) {
        EXPECT_EQ(text.find(word), std::string::npos) << text;
      }
    }
  }
  EXPECT_THAT(advice_for_unexplained({{"gain", "v", 0.9}}, "force_driven_axis"),
              HasSubstr("formula of v_mps ([formula_effects.NAME], site = \"force\")"));
  const std::string servo = advice_for_unexplained({{"force", "v", 0.9}}, "velocity_servo");
  EXPECT_EQ(servo.find("site = \"force\""), std::string::npos) << servo;
}

TEST(AdviceForChanges, AsksAboutTheRecordThatDiffersOrAboutTheTimeWithinOne) {
  selection::ParameterChange change;
  change.parameter = "mass_kg";
  EXPECT_THAT(words_for_changes({change}), HasSubstr("during the record"));
  change.record = "tuesday.csv";
  EXPECT_THAT(words_for_changes({change}),
              AllOf(HasSubstr("for tuesday.csv"), Not(HasSubstr("during the record"))));
  selection::ParameterChange other = change;
  other.record = "monday.csv";
  EXPECT_THAT(words_for_changes({change, other, change}),
              HasSubstr("for monday.csv and tuesday.csv, and"));
}

TEST(MotionWords, TellKindNumbersPlaceAndLength) {
  monitor::control::ReferenceConfig reference;
  reference.kind = "multisine";
  reference.amplitude_m = 0.04;
  EXPECT_EQ(motion_words(reference, 30.0),
            "a multisine of 0.1 to 1.9 Hz within 40 mm of 305 mm for 30 s");
  reference.kind = "steps";
  EXPECT_THAT(motion_words(reference, 30.0), StartsWith("fast steps every 1 s, each over 0.2 s"));
  reference.kind = "prbs";
  EXPECT_THAT(motion_words(reference, 30.0), StartsWith("a random binary motion"));
  reference.kind = "chirp";
  EXPECT_THAT(motion_words(reference, 30.0), StartsWith("a chirp from 0.5 to 5 Hz"));
}

}  // namespace
}  // namespace workbench::diagnose
