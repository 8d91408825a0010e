#include "workbench/diagnose/doubt_words.h"

#include <gmock/gmock.h>

#include "tests/workbench/diagnose/example_outcome.h"
#include "workbench/diagnose/verdict_words.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(DoubtWords, AFileThatMayBeWrongIsTheOtherPossibility) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.possible = {{"friction", selection::Doubt::below_noise}};
  selection::ModelStage without;
  for (const char* const name : {"mass_kg", "damping_N_s_per_m", "supply_pressure_Pa"})
    without.fitted.parameters.emplace_back().name = name;
  without.fitted.at_bound = {0, 1, 0};
  d.search.path = {without};
  EXPECT_THAT(doubt_words(d),
              ElementsAre(HasSubstr("Not established: friction (noise explains the model without"),
                          "Without friction, damping_N_s_per_m ends at its bound: either friction "
                          "is missing, or the file is wrong about damping_N_s_per_m."));
  d.search.path.front().fitted.at_bound = {0, 1, -1};
  EXPECT_THAT(doubt_words(d).back(), HasSubstr("the file is wrong about these values."));
  d.search.path.front().fitted.at_bound = {0, 0, 0};
  EXPECT_THAT(doubt_words(d), ElementsAre(HasSubstr("Not established")));
}

TEST(DoubtWords, EveryReasonIsAnExplanation) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.possible = {{"friction", selection::Doubt::undriven}, {"backlash", selection::Doubt::strained}};
  EXPECT_THAT(doubt_words(d),
              ElementsAre(AllOf(HasSubstr("speaks for it, its commanded motion hardly does"),
                                HasSubstr("end at their bounds beside it"))));
}

TEST(DoubtWords, AnErrorOfFittedSamplesAloneIsSaidToBeThere) {
  ExampleReport outcome;
  selection::Diagnosis& d = outcome.diagnosis;
  d.verdict = selection::Verdict::unexplained;
  d.missing.clear();
  d.rms_after_m = d.floor_m();
  d.fitted_rms_m = 20.0 * d.floor_m();
  EXPECT_THAT(verdict_words(d), HasSubstr("remains in the samples that are fitted, 20"));
}

}  // namespace
}  // namespace workbench::diagnose
