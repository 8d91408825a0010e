// The daemon's answers as people read them.
#include "workbench/control/answer_text.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace workbench::control {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

std::string status_with(const ordered_json& more) {
  ordered_json status = {{"rig_id", "stand"}, {"state", "RUN"}};
  status.update(more);
  std::ostringstream out;
  print_status(status, out);
  return out.str();
}

ordered_json active(const char* kind, const ordered_json& value) {
  return {{"id", "g"}, {"kind", kind}, {"action", "indicate"}, {"active", true}, {"value", value}};
}

TEST(StatusText, GivesTheValueOfAGuardInItsUnit) {
  const std::string text =
      status_with({{"guards",
                    {active("pressure", 9.31e6), active("travel", 0.4123), active("speed", 0.51),
                     active("stale", 0.02), active("saturated", -10.0)}}});
  for (const char* value :
       {"(pressure, indicate) is active: 93.1 bar\n", "(travel, indicate) is active: 412.3 mm\n",
        "(speed, indicate) is active: 510 mm/s\n", "(stale, indicate) is active: 20 ms\n",
        "(saturated, indicate) is active: -10 V\n"}) {
    EXPECT_THAT(text, HasSubstr(value));
  }
}

TEST(StatusText, GivesNoValueWhereNothingIsRead) {
  EXPECT_THAT(status_with({{"guards", {active("transducer", nullptr)}}}),
              HasSubstr("(transducer, indicate) is active\n"));
}

TEST(StatusText, GivesSpareRodsInMillimetresAndPressuresInBar) {
  const std::string text =
      status_with({{"spare_rods", {{{"id", "lvdt"}, {"value", 0.305}}}},
                   {"inputs",
                    {{{"id", "supply"}, {"role", "supply_pressure"}, {"value", 6.9e6}},
                     {{"id", "stop"}, {"role", "e_stop"}, {"value", 1.0}}}}});
  EXPECT_THAT(text, HasSubstr("spare rod lvdt: 305 mm\n"));
  EXPECT_THAT(text, HasSubstr("input supply: 69 bar\n"));
  EXPECT_THAT(text, HasSubstr("input stop: 1\n"));
}

}  // namespace
}  // namespace workbench::control
