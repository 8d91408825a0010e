#include "config/schema/flat_visitor.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "config/schema/document.h"

namespace config::schema {
namespace {

struct Switch {
  std::string id = "e_stop";
  void visit(Visitor& v) { v.text({"id", "its name", true}, id); }
};

struct Bench {
  double gain = 2.0;
  std::string model = "models/rig.toml";
  std::string folder;
  std::vector<Switch> switches{{}};

  void visit(Visitor& v) {
    v.table("sim", [this](Visitor& t) {
      t.path("model", model, "model.toml");
      t.number(wiring("gain"), gain);
    });
    visit_list(v, "switch", switches);
    v.path("folder", folder);
  }
};

TEST(FlatVisitor, ListsFieldsTableByTableWithTheirFlags) {
  Bench bench;
  const std::vector<FlatTable> tables = flatten([&](Visitor& v) { bench.visit(v); });
  ASSERT_EQ(tables.size(), 3U);

  EXPECT_EQ(tables[0].header(), "");
  ASSERT_EQ(tables[0].fields.size(), 1U) << "the top of the file comes before its tables";
  EXPECT_EQ(tables[0].fields[0].key, "folder");
  EXPECT_EQ(tables[0].fields[0].value, "\"\"");
  EXPECT_EQ(tables[0].fields[0].evidence_copy, "");

  EXPECT_EQ(tables[1].header(), "[sim]");
  ASSERT_EQ(tables[1].fields.size(), 2U);
  EXPECT_EQ(tables[1].fields[0].value, "\"models/rig.toml\"");
  EXPECT_EQ(tables[1].fields[0].path, "models/rig.toml");
  EXPECT_EQ(tables[1].fields[0].evidence_copy, "model.toml");
  EXPECT_FALSE(tables[1].fields[0].wiring);
  EXPECT_EQ(tables[1].fields[1].value, "2.0");
  EXPECT_TRUE(tables[1].fields[1].wiring);

  EXPECT_EQ(tables[2].header(), "[[switch]]");
  EXPECT_TRUE(tables[2].element);
}

TEST(Document, TakesARelativePathOfAnAssignmentFromTheCurrentFolder) {
  const auto model_of = [](const std::string& assignment) {
    Document document = Document::parse("schema_version = 1\n[sim]\nmodel = \"a.toml\"\n", "x");
    if (!assignment.empty()) document.set(assignment);
    Bench bench;
    document.read([&](Visitor& v) { bench.visit(v); });
    return bench.model;
  };
  EXPECT_EQ(model_of(""), "a.toml");
  EXPECT_EQ(model_of("sim.model=b/c.toml"),
            (std::filesystem::current_path() / "b/c.toml").string());
  EXPECT_EQ(model_of("sim.model=\"d.toml\""),
            (std::filesystem::current_path() / "d.toml").string());
  EXPECT_EQ(model_of("sim.model=/e.toml"), "/e.toml");
  EXPECT_EQ(model_of("sim.model="), "");
}

}  // namespace
}  // namespace config::schema
