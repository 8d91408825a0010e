#include "config/schema/reference.h"

#include <gmock/gmock.h>

#include <limits>
#include <string>

namespace {

using config::schema::Visitor;
using testing::HasSubstr;
using testing::Not;

struct Tank {
  std::string id;
  double level_m = 0.5;
  double limit_Pa = std::numeric_limits<double>::quiet_NaN();

  void visit(Visitor& v) {
    v.text({"id", "its name", true}, id);
    v.number({"level_m", "height | at the start"}, level_m, {1e-4, 2.0});
    v.number({"limit_Pa", "greatest pressure"}, limit_Pa,
             {0.0, std::numeric_limits<double>::infinity()});
  }
};

struct Plant {
  std::string kind = "closed";
  std::string pump = "none";
  bool drained = false;
  double slope = 1.0;
  std::int64_t stages = 2;
  std::vector<Tank> tanks;

  void visit(Visitor& v) {
    v.choice({"kind", "what it is"}, kind, {"closed", "open"});
    if (kind == "open") v.number({"slope", "of the weir"}, slope, {0.0, 1.0});
    v.optional_table({"drain", "where water leaves"}, drained, [&](Visitor& t) {
      t.integer({"stages", "in a row"}, stages, {1, 9});
    });
    v.table({"supply", "what fills it"}, [&](Visitor& t) {
      t.text({"pump", "which one"}, pump);
      if (pump != "none") t.number({"rate_mps", "of the water"}, slope);
    });
    if (pump == "screw") {
      v.table({"screw", "table of that pump"}, [&](Visitor& t) { t.number({"slope", ""}, slope); });
    }
    config::schema::visit_list(v, {"tank", "one tank"}, tanks);
  }
};

std::string reference() {
  return config::schema::print_reference([](Visitor& v) { Plant().visit(v); }, 2,
                                         {{"pump", {"none", "gear", "screw"}}});
}

TEST(Reference, ListsKeysWithUnitRangeAndDefault) {
  const std::string text = reference();
  EXPECT_THAT(text, HasSubstr("\n## `[[tank]]`\n\nOne tank.\n"));
  EXPECT_THAT(text, HasSubstr("| `id` | text |  | must be given | its name |\n"));
  EXPECT_THAT(text, HasSubstr("| `level_m` | number, m | 0.0001 to 2 | 0.5 | height \\| at the "
                              "start |\n"));
  EXPECT_THAT(text, HasSubstr("| `limit_Pa` | number, Pa | 0 and more |  | greatest pressure |\n"));
  EXPECT_THAT(text, HasSubstr("## `[drain]`\n\nWhere water leaves.\n"));
  EXPECT_THAT(text, HasSubstr("| `stages` | integer | 1 to 9 | 2 | in a row |\n"));
}

TEST(Reference, SaysWhichChoiceBringsAKey) {
  const std::string text = reference();
  EXPECT_THAT(text, HasSubstr("| `kind` | text | `closed`, `open` | \"closed\" | what it is |\n"
                              "| `slope` | number | 0 to 1 | 1 | of the weir; with `kind` = "
                              "\"open\" |\n"));
  EXPECT_THAT(text, HasSubstr("| of the water; with `pump` other than \"none\" |\n"));
  EXPECT_THAT(text, HasSubstr("Table of that pump; with `supply.pump` = \"screw\".\n"));
  EXPECT_THAT(text, HasSubstr("| `slope` | number |  | 1 |  |\n"));
  EXPECT_THAT(text, Not(HasSubstr("Top of the file\n\n\n")));
}

}  // namespace
