#include "workbench/present/record_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace workbench::present {
namespace {

using config::record::Record;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr double kTs = 0.005;

/// A servo of 20 mm/s per V on several sines, as a file with these columns and units.
Record servo() {
  Record record;
  record.sample_time_s = kTs;
  double y_m = 0.2;
  for (int k = 0; k < 4000; ++k) {
    const double t_s = kTs * k;
    const double u_V = std::sin(1.1 * t_s) + std::sin(3.7 * t_s + 1.0) + std::sin(9.1 * t_s);
    record.t_s.push_back(t_s);
    record.u_V.push_back(u_V);
    record.y_m.push_back(y_m);
    y_m += 0.02 * u_V * kTs;
  }
  const auto origin = [&record](const char* name, const char* header, const char* unit) {
    config::record::ChannelOrigin channel;
    channel.name = name;
    channel.header = header;
    channel.unit = unit;
    record.origins.push_back(channel);
  };
  origin("t_s", "Time [s]", "s");
  origin("u_V", "Command", "V");
  origin("y_m", "Position [m]", "m");
  return record;
}

TEST(RecordFindings, AreEmptyForARecordInOrder) {
  EXPECT_THAT(record_findings(servo()), IsEmpty());
}

TEST(RecordFindings, AskForMillimetresWhereThePositionSpansTooMuch) {
  Record record = servo();
  for (double& y_m : record.y_m) y_m *= 1000.0;
  EXPECT_THAT(record_findings(record),
              ElementsAre(HasSubstr("more than a stand's stroke: is it mm? --map "
                                    "'y=Position[mm]'")));
  record.origins.clear();
  EXPECT_THAT(record_findings(record), ElementsAre(HasSubstr("is its unit right?")));
}

TEST(RecordFindings, TakeNoDropoutOrOutlierForAUnit) {
  Record record = servo();
  for (std::size_t k = 100; k < record.y_m.size(); k += 500) {
    record.y_m[k] = k % 1000 < 500 ? 65.535 : 0.0;
    record.u_V[k] = 1e4;
  }
  EXPECT_THAT(record_findings(record), IsEmpty());
  Record far = servo();  // away from zero: a row of zeros is far off
  for (double& y_m : far.y_m) y_m += 40.0;
  far.y_m[1000] = 0.0;
  EXPECT_THAT(record_findings(far), IsEmpty());
  // a wrong unit shows among dropouts
  for (double& y_m : record.y_m) y_m *= 1000.0;
  for (double& u_V : record.u_V) u_V = std::min(u_V, 3.0);
  EXPECT_THAT(record_findings(record), ElementsAre(HasSubstr("is it mm?")));
}

TEST(RecordFindings, AskForMillivoltsAndMilliseconds) {
  Record record = servo();
  for (double& u_V : record.u_V) u_V *= 1000.0;
  for (double& t_s : record.t_s) t_s *= 1000.0;
  record.sample_time_s *= 1000.0;
  EXPECT_THAT(record_findings(record),
              ElementsAre(HasSubstr("V: is it mV? --map 'u=Command[mV]'"),
                          StartsWith("the time steps by 5 s: is it ms? --map 't=Time[ms]'")));
}

TEST(RecordFindings, NameASignThatIsTurnedWithWhatTurnsItBack) {
  Record record = servo();
  for (double& u_V : record.u_V) u_V = -u_V;
  EXPECT_THAT(record_findings(record),
              ElementsAre(HasSubstr("moves against the command (speed and command correlate by "
                                    "-1.00): is a sign turned? A positive command extends; --flip "
                                    "turns the command")));
  record.origins.back().factor = -1.0;  // a mapping has turned it
  EXPECT_THAT(record_findings(record), ElementsAre(EndsWith("--map y=Position")));
  record.origins.back().header = "Pos";
  EXPECT_THAT(record_findings(record), ElementsAre(EndsWith("--map 'y=Pos[m]'")));
}

TEST(RecordFindings, NameExchangedColumnsAndNothingElse) {
  Record record = servo();
  std::swap(record.u_V, record.y_m);
  EXPECT_THAT(record_findings(record),
              ElementsAre(EndsWith("the other way round, --map u=Position,y=Command")));
}

TEST(RecordFindings, NameClocksThatAreShifted) {
  Record record = servo();
  record.u_V.erase(record.u_V.end() - 20, record.u_V.end());
  record.y_m.erase(record.y_m.begin(), record.y_m.begin() + 20);
  record.t_s.resize(record.y_m.size());
  EXPECT_THAT(
      record_findings(record),
      ElementsAre(AllOf(HasSubstr("moves 100 ms before the command that drives it: the clocks"),
                        EndsWith("; --advance of about 0.1, beside one already given, takes the "
                                 "command earlier"))));
}

TEST(StrokeFinding, NamesTheStrokeAndTheUnit) {
  const greybox::SourceColumn metres{"Position", "m"};
  EXPECT_EQ(stroke_finding(90.0, 502.0, 0.61, metres),
            "the position looks 1000 times too large for stroke_m = 0.61 (span 412 m): is it mm? "
            "--map 'y=Position[mm]'");
  EXPECT_THAT(stroke_finding(1e-4, 5e-4, 0.61, {"Position", "mm"}),
              HasSubstr("too small for stroke_m = 0.61 (from 0.1 to 0.5 mm): is it m?"));
  EXPECT_EQ(stroke_finding(0.1, 0.5, 0.61, metres), "");
}

TEST(SizeFinding, AsksAnAxisWithoutAStrokeForItsTravel) {
  const greybox::MotionRatio unlike{30.0, 0.1};
  const greybox::SourceColumn metres{"Pos", "m"};
  EXPECT_EQ(size_finding({2.0, 73.4}, 0.0, unlike, {"Cmd", "V"}, metres),
            "the position spans 71.4 m, more than a stand's stroke: is it mm? --map 'y=Pos[mm]'");
  EXPECT_EQ(size_finding({2.0, 23.4}, 0.0, unlike, {"Cmd", "V"}, metres), "");
  EXPECT_EQ(size_finding({2.0, 73.4}, 100.0, unlike, {"Cmd", "V"}, metres), "");
}

TEST(MotionFinding, NamesThePositionOrTheCommand) {
  EXPECT_EQ(motion_finding({603.0, 0.99}, {"Cmd", "mV"}, {"Pos", "m"}),
            "the rod moves 603 times as far as the model: the position: is it mm? --map "
            "'y=Pos[mm]'; or the command: is it V? --map 'u=Cmd[V]'");
  EXPECT_EQ(motion_finding({0.001, 0.99}, {"Cmd", "V"}, {"Pos", "m"}),
            "the rod moves 1/1000 as far as the model: the command: is it mV? --map 'u=Cmd[mV]'");
  EXPECT_EQ(motion_finding({1.2, 0.99}, {"Cmd", "V"}, {"Pos", "m"}), "");
}

}  // namespace
}  // namespace workbench::present
