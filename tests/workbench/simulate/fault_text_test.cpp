#include "workbench/simulate/fault_text.h"

#include <gmock/gmock.h>

#include <cmath>

#include "config/schema/error.h"

namespace workbench::simulate {
namespace {

TEST(FaultText, ReadsAValueAtATime) {
  const auto change = parse_fault("friction.coulomb_N=200@10");
  EXPECT_EQ(change.parameter, "friction.coulomb_N");
  EXPECT_EQ(change.value, 200.0);
  EXPECT_TRUE(std::isnan(change.factor));
  EXPECT_EQ(change.at_s, 10.0);
  EXPECT_EQ(change.ramp_s, 0.0);
}

TEST(FaultText, ReadsAFactorWithARamp) {
  const auto change = parse_fault("supply_pressure_Pa*1.25@15+2.5");
  EXPECT_EQ(change.factor, 1.25);
  EXPECT_TRUE(std::isnan(change.value));
  EXPECT_EQ(change.at_s, 15.0);
  EXPECT_EQ(change.ramp_s, 2.5);
}

TEST(FaultText, TakesThePlusOfAnExponentForWhatItIs) {
  const auto change = parse_fault("supply_pressure_Pa=8.6e+6@1.5e+1+2");
  EXPECT_EQ(change.value, 8.6e6);
  EXPECT_EQ(change.at_s, 15.0);
  EXPECT_EQ(change.ramp_s, 2.0);
}

TEST(FaultText, RefusesEverythingElse) {
  for (const char* text : {"", "=1@2", "a=1", "a@1", "a=x@1", "a=1@", "a=1@-1", "a=1@1+", "a=1@1+x",
                           "a=1@1+-2", "a=nan@1", "a=1 @1", "a=1@1s"}) {
    try {
      static_cast<void>(parse_fault(text));
      ADD_FAILURE() << text;
    } catch (const config::schema::UsageError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("allowed"));
    }
  }
}

}  // namespace
}  // namespace workbench::simulate
