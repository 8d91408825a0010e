// The live view: what it draws, and that it runs on a terminal.
#include <gtest/gtest.h>
#include <cmath>
#include <cstdlib>
#include <string>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "workbench/live/live_state.h"
#include "workbench/live/live_view.h"

namespace workbench::live {
namespace {

constexpr std::int64_t kSecond_us = 1'000'000;

spoolwatch::estimate_t b1(double value, double t_s) {
  spoolwatch::estimate_t estimate{};
  estimate.utc_us = static_cast<std::int64_t>(t_s * kSecond_us);
  estimate.source = "period";
  estimate.valid = 1;
  estimate.size = 2;
  estimate.name = {"a1", "b1"};
  estimate.value = {-1.0, value};
  estimate.std_error = {config::signals::kNaN, 1e-6};
  estimate.low = {config::signals::kNaN, 1.0};
  estimate.high = {config::signals::kNaN, 3.0};
  return estimate;
}

class LiveTest : public testing::Test {
 protected:
  [[nodiscard]] std::string row_with(const std::wstring& part, int rows = 24,
                                     int columns = 80) const {
    const live::Canvas canvas = live::draw(state_, rows, columns, live::Glyphs::ascii());
    for (int row = 0; row < canvas.rows(); ++row) {
      std::wstring text;
      for (int column = 0; column < columns; ++column) text += canvas.at(row, column).glyph;
      text.erase(text.find_last_not_of(L' ') + 1);
      if (text.find(part) != std::wstring::npos) return {text.begin(), text.end()};
    }
    return "";
  }

  live::LiveState state_;
};

TEST_F(LiveTest, PutsTheMarkerWhereTheValueIsInItsBand) {
  state_.on_new_run(1, true);
  // The bar shows 0.5 to 3.5 on 56 cells: 1 is at round(55/6), 2 in the middle, 3 at round(55*5/6).
  state_.on(b1(2.0, 1.0));
  const std::string bar = row_with(L"|=");
  const auto first = bar.find('.');
  EXPECT_EQ(bar.find('|') - first, 9U);
  EXPECT_EQ(bar.rfind('|') - first, 46U);
  EXPECT_EQ(bar.find('#') - first, 28U);
  EXPECT_NE(row_with(L"period.b1").find("inside its band"), std::string::npos);
  state_.on(b1(0.7, 2.0));
  EXPECT_NE(row_with(L"period.b1").find("BELOW ITS BAND"), std::string::npos);
  state_.on(b1(99.0, 3.0));
  EXPECT_NE(row_with(L"period.b1").find("ABOVE ITS BAND"), std::string::npos);
  // Off the scale: at the bar's end.
  const std::string off = row_with(L"|=");
  EXPECT_EQ(off.find('#') - off.find('.'), 55U);
}

TEST_F(LiveTest, ShowsReferencePositionErrorAndState) {
  spoolwatch::sample_t sample{};
  sample.reference_m = 0.0125;
  sample.y_m = 0.0120;
  sample.u_applied_V = -1.5;
  sample.state = 3;
  state_.on_new_run(1, true);
  state_.on(sample);
  const std::string row = row_with(L"reference");
  EXPECT_NE(row.find("reference +12.500 mm"), std::string::npos) << row;
  EXPECT_NE(row.find("position +12.000 mm"), std::string::npos) << row;
  EXPECT_NE(row.find("error +0.500 mm"), std::string::npos) << row;
  EXPECT_NE(row.find("u -1.500 V"), std::string::npos) << row;
  EXPECT_NE(row_with(L"SPOOLWATCH").find("RUN"), std::string::npos);
}

TEST_F(LiveTest, ShowsTheNewestAlarmChangeFirstAndRepeatsDoNotCountAsChanges) {
  state_.on_new_run(1, true);
  const auto alarm = [&](const char* name, double t_s, bool active) {
    spoolwatch::alarm_t message{};
    message.source = "period";
    message.name = name;
    message.utc_us = static_cast<std::int64_t>(t_s * kSecond_us);
    message.severity = active ? 2 : 0;
    message.active = active ? 1 : 0;
    state_.on(message);
  };
  alarm("first", 1.0, true);
  alarm("second", 2.0, true);
  alarm("first", 3.0, true);  // a repeat
  ASSERT_EQ(state_.alarms().size(), 2U);
  EXPECT_EQ(state_.alarms()[0].name, "period.second");
  EXPECT_NE(row_with(L"alarms:").find("2 active"), std::string::npos);
  alarm("first", 4.0, false);
  EXPECT_EQ(state_.alarms()[0].name, "period.first");
  EXPECT_NE(row_with(L"alarms:").find("1 active"), std::string::npos);
  EXPECT_NE(row_with(L"period.first").find("back to normal"), std::string::npos);
}

TEST_F(LiveTest, ShowsLatenessAndCounts) {
  spoolwatch::health_t health{};
  health.lateness_p999_us = 18.42;
  health.lateness_max_us = 1234.0;
  health.overruns = 2;
  health.dropped_samples = 3;
  health.dropped_records = 4;
  state_.on_new_run(1, true);
  state_.on(health);
  EXPECT_EQ(row_with(L"late p99.9").substr(1, 44), "late p99.9 18.4  max 1234 us  overruns 2  sk");
  EXPECT_NE(row_with(L"late p99.9").find("dropped 7"), std::string::npos);
}

TEST_F(LiveTest, DrawsOnAnySizeOfTerminalAndWithAnyNumbers) {
  state_.on_new_run(1, true);
  spoolwatch::sample_t sample{};
  sample.y_m = config::signals::kNaN;
  sample.reference_m = HUGE_VAL;
  state_.on(sample);
  for (const double value : {config::signals::kNaN, HUGE_VAL, -HUGE_VAL, 0.0})
    state_.on(b1(value, 1.0));
  for (const auto& [rows, columns] : {std::pair{1, 1}, {5, 20}, {24, 80}, {60, 300}}) {
    const live::Canvas canvas = live::draw(state_, rows, columns, live::Glyphs::unicode());
    EXPECT_EQ(canvas.rows(), rows);
  }
}

// The program on a real terminal, with messages from a process that acts as the daemon.
TEST(LiveView, ShowsARunningDaemonInATerminalAndQuitsOnQ) {
  if (std::system("command -v tmux >/dev/null") != 0) GTEST_SKIP() << "tmux is not installed";
  const std::string script = std::string(SPOOLWATCH_SOURCE_DIR) +
                             "/tests/workbench/live/live_in_tmux.sh " + SPOOLWATCH_BIN_DIR +
                             "/spoolwatch " + SPOOLWATCH_FAKE_DAEMON;
  EXPECT_EQ(std::system(script.c_str()), 0);
}

}  // namespace
}  // namespace workbench::live
