// The sentences on what changes in time or from record to record.
#include "workbench/diagnose/change_words.h"

#include <gtest/gtest.h>

namespace workbench::diagnose {
namespace {

TEST(ChangeWords, StepsNameWhatChangesAndInWhichRecord) {
  EXPECT_EQ(step_name("friction + backlash"), "friction + backlash");
  EXPECT_EQ(step_name("change.mass_kg"), "mass_kg that changes");
  EXPECT_EQ(step_name("friction + change.mass_kg@b.csv"), "friction + mass_kg of b.csv");
}

TEST(ChangeWords, ADifferenceBetweenRecordsNamesTheRecordThatDiffers) {
  selection::ParameterChange change;
  change.kind = selection::ChangeKind::record;
  change.parameter = "mass_kg";
  change.record = "b.csv";
  change.from = 50.0;
  change.from_error = 0.5;
  change.to = 60.0;
  change.to_error = 0.5;
  EXPECT_EQ(change_words(change),
            "mass_kg is 60.0 +- 0.5 kg in b.csv and 50.0 +- 0.5 kg elsewhere");
}

TEST(ChangeWords, TheTimeOfAStepHasItsErrorWhereThatIsMoreThanTheLastDigit) {
  selection::ParameterChange change;
  change.parameter = "mass_kg";
  change.from = 50.0;
  change.from_error = 0.5;
  change.to = 60.0;
  change.to_error = 0.5;
  change.at_s = 12.3456;
  change.at_error_s = 0.001;
  const std::string step = "mass_kg goes from 50.0 +- 0.5 kg to 60.0 +- 0.5 kg at ";
  EXPECT_EQ(change_words(change), step + "12.35 s");
  change.at_error_s = 0.4;
  EXPECT_EQ(change_words(change), step + "12.3 +- 0.4 s");
}

}  // namespace
}  // namespace workbench::diagnose
