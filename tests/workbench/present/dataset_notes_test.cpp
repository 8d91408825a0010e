#include "workbench/present/dataset_notes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  note_changes(model, data);
  return data.notes;
}

std::string change(const std::string& parameter, double value, double at_s) {
  return "[[change]]\nparameter = \"" + parameter + "\"\nvalue = " + std::to_string(value) +
         "\nat_s = " + std::to_string(at_s) + "\n";
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

}  // namespace
}  // namespace workbench::present
