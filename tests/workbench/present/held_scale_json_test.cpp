#include "workbench/present/held_scale_json.h"

#include <gtest/gtest.h>

#include "config/schema/document.h"

namespace workbench::present {
namespace {

TEST(HeldScaleJson, NamesBothAreasOfACylinder) {
  const auto model = plant_sim::read_model(config::schema::Document::parse(
      "schema_version = 1\nname = \"a\"\nplant = \"hydraulic_cylinder\"\n[effects.supply_droop]\n"
      "droop_Pa_per_m3ps = 5e9\n",
      "a.toml"));
  EXPECT_EQ(
      json_of(estimator::greybox::held_scale(model, {"mass_kg", "supply_droop.droop_Pa_per_m3ps"}))
          .dump(),
      R"({"parameter":"cap_area_m2","also_held":["rod_side_area_m2"],)"
      R"("scaled":["mass_kg"],"inverse":["supply_droop.droop_Pa_per_m3ps"]})");
}

TEST(HeldScaleJson, IsNullWhereNothingIsHeld) {
  EXPECT_TRUE(json_of(estimator::greybox::HeldScale{}).is_null());
}

}  // namespace
}  // namespace workbench::present
