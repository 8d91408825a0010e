#include "workbench/present/dataset_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "config/schema/document.h"

namespace workbench::present {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// 10 s from 100 s on, the rod at 0.3 m.
estimator::greybox::Dataset record() {
  estimator::greybox::Dataset data;
  for (int k = 0; k <= 1000; ++k) {
    data.t_s.push_back(100.0 + 0.01 * k);
    data.u_V.push_back(0.0);
    data.y_m.push_back(0.3);
  }
  return data;
}

std::vector<std::string> noted(const std::string& changes) {
  const auto model = plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"a\"\nplant = \"hydraulic_actuator\"\n[initial]\ny_m = 0.05\n" +
          changes,
      "a.toml"));
  estimator::greybox::Dataset data = record();
  note_against_model(model, data);
  return data.notes;
}

std::string change(const std::string& parameter, double value, double at_s) {
  return "[[change]]\nparameter = \"" + parameter + "\"\nvalue = " + std::to_string(value) +
         "\nat_s = " + std::to_string(at_s) + "\n";
}

std::string rated_command_note(const std::string& unit, double rated_V, bool scaled = false) {
  auto model = plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"a\"\nplant = \"hydraulic_cylinder\"\n", "a.toml"));
  *model.value("rated_command_V") = rated_V;
  estimator::greybox::Dataset data = record();
  data.command_column.unit = unit;
  data.command_column.scaled = scaled;
  note_against_model(model, data);
  return data.notes.empty() ? "" : data.notes.front();
}

TEST(DatasetNotes, AskForTheRatedCommandWhereTheCommandIsInPerCent) {
  EXPECT_EQ(rated_command_note("V", 10.0), "");
  EXPECT_EQ(rated_command_note("%", 10.0, true), "");
  EXPECT_EQ(rated_command_note("pct", 95.0), "");
  EXPECT_EQ(rated_command_note("Prozent", 10.0),
            "the command is in %, and the model reaches its rated flow at 10 %: where 100 % opens "
            "the valve fully, use --set parameters.rated_command_V=100");
}

TEST(DatasetNotes, SayThatChangesBelongToOneRecord) {
  EXPECT_THAT(noted(""), IsEmpty());
  EXPECT_THAT(noted(change("mass_kg", 60.0, 102.0)),
              ElementsAre("the model changes mass_kg at 102 s: that is of the one record in which "
                          "it happened"));
  EXPECT_THAT(noted(change("mass_kg", 60.0, 102.0) + change("load_force.force_N", 100.0, 110.0)),
              ElementsAre("the model changes mass_kg at 102 s and load_force.force_N at 110 s: "
                          "that is of the one record in which it happened"));
}

TEST(DatasetNotes, NameChangesOutsideTheRecord) {
  EXPECT_THAT(
      noted(change("mass_kg", 60.0, 500.0) + change("load_force.force_N", 100.0, 2.5)),
      ElementsAre("the model changes mass_kg at 500 s, this record ends at 110 s: it never sets in",
                  "the model changes load_force.force_N at 2.5 s, this record begins at 100 s: it "
                  "has set in before"));
}

TEST(DatasetNotes, NameAStrokeThatTheRodIsBeyond) {
  EXPECT_THAT(noted(change("stroke_m", 0.1, 105.0)),
              ElementsAre("the model changes stroke_m at 105 s, to 100 mm: the rod is at 300 mm "
                          "after it"));
  EXPECT_THAT(noted(change("stroke_m", 0.4, 105.0)), testing::SizeIs(1));
  EXPECT_THAT(noted(change("stroke_m", 0.4, 105.0)).front(), testing::HasSubstr("one record"));
}

/// A record in which the position follows the command between two values and stays at neither.
estimator::greybox::Dataset ramps(double from_m, double to_m, double begin_s) {
  estimator::greybox::Dataset data;
  data.name = "bench.csv";
  data.sample_time_s = 0.01;
  data.starts = {0};
  double y_m = from_m;
  for (int k = 0; k < 1000; ++k) {
    const double u_V = k % 200 < 100 ? 1.0 : -1.0;
    data.t_s.push_back(begin_s + 0.01 * k);
    data.u_V.push_back(u_V);
    data.y_m.push_back(std::round(1e5 * y_m) / 1e5);
    y_m = std::clamp(y_m + 0.01 * u_V * 2.0 * (to_m - from_m), from_m, to_m);
  }
  data.valid.assign(data.size(), 1);
  return data;
}

TEST(DatasetNotes, TheEndOfABlockIsNoEndOfTheSensor) {
  // each block stays at its own ends, of which two are those of the record
  const std::vector<estimator::greybox::Dataset> blocks{ramps(0.1, 0.2, 0.0),
                                                        ramps(0.2, 0.3, 10.0)};
  const std::vector<std::string> notes = notes_of(blocks);
  ASSERT_THAT(notes, testing::SizeIs(2));
  EXPECT_THAT(notes[0], testing::HasSubstr("bench.csv: the position stays at exactly 100 mm"));
  EXPECT_THAT(notes[1], testing::HasSubstr("stays at exactly 300 mm"));
}

}  // namespace
}  // namespace workbench::present
