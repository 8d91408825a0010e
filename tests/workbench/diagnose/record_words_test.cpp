// The sentences on how a record was read.
#include "workbench/diagnose/record_words.h"
#include "workbench/diagnose/diagnosis_report.h"
#include "workbench/diagnose/verdict_words.h"
#include "workbench/diagnose/words.h"

#include <gmock/gmock.h>

#include "tests/workbench/diagnose/example_outcome.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(RecordWords, AResponseThatTheModelExplainsIsNoFaultOfTheRecord) {
  ExampleReport outcome;
  outcome.input.problem.data.records.resize(1);
  outcome.input.problem.data.records.front().name = "bench.csv";
  selection::RecordChecks checks;
  checks.responses = {{-0.8, 0.08}};
  outcome.diagnosis.checks = checks;
  EXPECT_THAT(remarks(outcome), Not(Contains(HasSubstr("against the command"))));
  EXPECT_THAT(remarks(outcome), Not(Contains(HasSubstr("late"))));
  outcome.diagnosis.missing = {"transport_delay"};
  EXPECT_THAT(remarks(outcome), Contains(HasSubstr("clocks that are shifted")));
  outcome.diagnosis.missing.clear();
  outcome.diagnosis.verdict = selection::Verdict::unexplained;
  EXPECT_THAT(remarks(outcome), Contains(HasSubstr("against the command")));
  EXPECT_THAT(remarks(outcome), Contains(HasSubstr("80 ms late")));
}

TEST(RecordWords, AStrokeThatIsLeftAtBothEndsHasBothOverruns) {
  ExampleReport outcome;
  outcome.input.problem.data.records.resize(1);
  selection::RecordChecks checks;
  checks.stroke_m = 0.5;
  checks.low_m = checks.below_m = -0.25;
  checks.high_m = 0.625;
  checks.beyond_m = 0.125;
  outcome.diagnosis.checks = checks;
  EXPECT_THAT(remarks(outcome),
              Contains(HasSubstr("leaves the model's stroke by 250 mm before its beginning and by "
                                 "125 mm beyond its end:")));
}

TEST(RecordWords, AMisreadRecordHasNoNextCommandAndIsNotSearched) {
  ExampleReport outcome;
  outcome.diagnosis.verdict = selection::Verdict::unexplained;
  outcome.diagnosis.missing.clear();
  selection::RecordChecks checks;
  checks.columns_exchanged = true;
  outcome.diagnosis.checks = checks;
  EXPECT_EQ(next_command(outcome), "");
  EXPECT_THAT(verdict_words(outcome.diagnosis), HasSubstr("What is missing was not sought"));
  EXPECT_THAT(verdict_words(outcome.diagnosis), Not(HasSubstr("--prior")));
  outcome.diagnosis.checks->wrong_scale = true;
  EXPECT_THAT(verdict_words(outcome.diagnosis), Not(HasSubstr("--prior")));
  outcome.diagnosis.parameters = {{"mass_kg", 50.0, 1.0}, {"valve_gain_m_per_V", 2e-5, 1e-7}};
  EXPECT_THAT(verdict_words(outcome.diagnosis),
              HasSubstr("free it with --prior valve_gain_m_per_V=none."));
}

TEST(RecordWords, ExchangedColumnsThatTheSearchFoundComeWithTheirMap) {
  ExampleReport outcome;
  greybox::Dataset record;
  record.command_column = {"Force", "V", false};
  record.position_column = {"Pos [m]", "m", false};
  outcome.input.problem.data.records = {record};
  outcome.diagnosis.checks.emplace();
  outcome.diagnosis.checks->columns_exchanged = true;
  outcome.diagnosis.checks->exchanged_ratio = 40.0;
  EXPECT_THAT(remarks(outcome),
              Contains(HasSubstr("40.0 times less of the motion remains; read them "
                                 "with --map u=Pos,y=Force.")));
  outcome.diagnosis.verdict = selection::Verdict::unexplained;
  outcome.diagnosis.checks->responses = {{-0.8, 0.0, 0.5}};
  EXPECT_THAT(remarks(outcome), Not(Contains(HasSubstr("--flip")))) << "one way to read it";
}

TEST(RecordWords, ATurnedPositionComesWithItsMap) {
  ExampleReport outcome;
  greybox::Dataset record;
  record.position_column = {"Pos [m]", "m", false};
  outcome.input.problem.data.records = {record};
  outcome.diagnosis.verdict = selection::Verdict::unexplained;
  outcome.diagnosis.checks.emplace();
  outcome.diagnosis.checks->position_turned = true;
  outcome.diagnosis.checks->responses = {{-0.8, 0.0, 0.0}};
  EXPECT_THAT(remarks(outcome),
              ElementsAre(AllOf(HasSubstr("its sign is turned (--map y=-Pos), or "),
                                HasSubstr("(--flip)"))));
  EXPECT_EQ(next_command(outcome), "");
}

TEST(RecordWords, RecordsThatDifferAreMendedOneByOne) {
  ExampleReport outcome;
  outcome.diagnosis.verdict = selection::Verdict::unexplained;
  outcome.input.problem.data.records.resize(2);
  outcome.input.problem.data.records.front().name = "turned.csv";
  outcome.input.problem.data.records.back().name = "good.csv";
  outcome.diagnosis.checks.emplace();
  outcome.diagnosis.checks->records_differ = true;
  outcome.diagnosis.checks->responses = {{-0.8, 0.0, 0.0}, {0.8, 0.0, 0.0}};
  EXPECT_THAT(remarks(outcome),
              ElementsAre(HasSubstr("turned.csv: the position moves against the command"),
                          HasSubstr("mend each by itself with import")));
  EXPECT_EQ(next_command(outcome), "");
}

TEST(RecordWords, ADelayThatTakesAnAdvanceBackIsDoubted) {
  ExampleReport outcome;
  outcome.diagnosis.missing = {"transport_delay"};
  outcome.input.reading.advance_command_s = 0.04;
  greybox::FreeParameter delay;
  delay.name = "transport_delay.delay_s";
  outcome.diagnosis.final.parameters = {delay};
  outcome.diagnosis.final.theta = Eigen::VectorXd::Constant(1, 0.04);
  const auto said = HasSubstr("takes back --advance 0.04");
  EXPECT_THAT(remarks(outcome), Contains(said));
  outcome.input.reading.advance_command_s = 0.1;
  EXPECT_THAT(remarks(outcome), Not(Contains(said)));
}

TEST(RecordWords, ACommandThatIsLoggedLateIsTakenEarlierByTheNextCommand) {
  ExampleReport outcome;
  outcome.diagnosis.verdict = selection::Verdict::unexplained;
  outcome.diagnosis.checks.emplace();
  outcome.diagnosis.checks->command_late_s = 0.05;
  EXPECT_EQ(next_command(outcome),
            "spoolwatch diagnose rig.toml bench.csv --advance 0.05 -o better.toml");
  EXPECT_THAT(remarks(outcome), ElementsAre(HasSubstr("logged 50 ms after it acts")));
  EXPECT_FALSE(outcome.has_better_model());
  outcome.input.reading.advance_command_s = 0.01;
  outcome.input.command = "spoolwatch diagnose rig.toml bench.csv --advance 0.01 --quiet";
  EXPECT_EQ(next_command(outcome),
            "spoolwatch diagnose rig.toml bench.csv --advance 0.06 --quiet -o better.toml");
}

}  // namespace
}  // namespace workbench::diagnose
