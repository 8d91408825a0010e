#include "workbench/present/disturbance_words.h"

#include <gtest/gtest.h>

#include "workbench/present/disturbance_json.h"

namespace workbench::present {
namespace {

namespace selection = estimator::greybox::selection;

selection::Disturbance line_and_noise() {
  selection::Disturbance d;
  d.as = "force";
  d.value = 3.0;
  d.corner_Hz = 1.0;
  d.lines.push_back({.as = "force", .frequency_Hz = 19.0, .amplitude = 2.0, .rms_m = 1e-6});
  return d;
}

TEST(DisturbanceWords, StateEachPartWithItsSize) {
  EXPECT_EQ(
      disturbance_words(line_and_noise()),
      "a random force of 3 N RMS, most of it below 1 Hz; a periodic force of 2 N at 19.00 Hz");
}

TEST(DisturbanceWords, NameEveryKindThatTheRecordDoesNotTellApart) {
  selection::Disturbance d = line_and_noise();
  d.lines.front().rivals.push_back({"sensor", 1.4e-6});
  EXPECT_EQ(
      disturbance_words(d),
      "a random force of 3 N RMS, most of it below 1 Hz; at 19.00 Hz a periodic force of 2 N or "
      "a vibration of the position sensor of 1.4 um (the record does not tell which)");
  const nlohmann::ordered_json line = disturbance_json(d).at("lines").at(0);
  EXPECT_EQ(line.at("as"), "force");
  EXPECT_EQ(line.at("rivals").at(0).at("as"), "sensor");
  EXPECT_EQ(line.at("rivals").at(0).at("amplitude"), 1.4e-6);
}

}  // namespace
}  // namespace workbench::present
