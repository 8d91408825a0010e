#include "config/schema/document.h"

#include <gmock/gmock.h>

#include <cmath>

#include "config/schema/error.h"

namespace config::schema {
namespace {

using testing::HasSubstr;

struct Pump {
  std::string name;
  double pressure_Pa = 1e6;
  void visit(Visitor& v) {
    v.text({"name", "what it is called", true}, name);
    v.number("pressure_Pa", pressure_Pa, {0.0, 3e7});
  }
};

struct Stand {
  bool enabled = false;
  std::int64_t rate_Hz = 200;
  double optional_m = NAN;
  std::string mode = "monitor";
  std::vector<double> levels{1.0, 2.5};
  std::vector<std::string> files;
  bool has_effect = false;
  double coulomb_N = 0.1;
  std::vector<Pump> pumps;

  void visit(Visitor& v) {
    v.boolean("enabled", enabled);
    v.table("loop", [this](Visitor& t) {
      t.integer("rate_Hz", rate_Hz, {1, 1000});
      t.choice("mode", mode, {"monitor", "control"});
      t.number("optional_m", optional_m);
    });
    v.numbers("levels", levels, {0.0, 10.0});
    v.texts("files", files);
    v.optional_table("effect", has_effect, [this](Visitor& t) {
      t.number("coulomb_N", coulomb_N, {0.0, 1e5});
    });
    visit_list(v, "pump", pumps);
  }
};

Stand read(const std::string& text, const std::vector<std::string>& sets = {}) {
  Document document = Document::parse("schema_version = 1\n" + text, "stand.toml");
  for (const std::string& set : sets) document.set(set);
  Stand stand;
  document.read([&](Visitor& v) { stand.visit(v); });
  return stand;
}

std::string message(const std::string& text, const std::vector<std::string>& sets = {}) {
  try {
    read(text, sets);
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << "must be one line";
    return std::to_string(config::schema::exit_code_of(e)) + " " + e.what();
  }
  return "no error";
}

TEST(Document, FillsEveryKindOfFieldAndKeepsDefaultsOfAbsentOnes) {
  const Stand stand = read(
      "enabled = true\nlevels = [3, 4.5]\nfiles = [\"a\", \"b\"]\n[loop]\nmode = \"control\"\n"
      "[effect]\ncoulomb_N = 150\n[[pump]]\nname = \"p1\"\n[[pump]]\nname = \"p2\"\n"
      "pressure_Pa = 2e6\n");
  EXPECT_TRUE(stand.enabled);
  EXPECT_EQ(stand.rate_Hz, 200);
  EXPECT_EQ(stand.mode, "control");
  EXPECT_EQ(stand.levels, (std::vector<double>{3.0, 4.5}));
  EXPECT_EQ(stand.files, (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(stand.has_effect);
  EXPECT_EQ(stand.coulomb_N, 150.0);
  ASSERT_EQ(stand.pumps.size(), 2U);
  EXPECT_EQ(stand.pumps[0].pressure_Pa, 1e6);
  EXPECT_EQ(stand.pumps[1].pressure_Pa, 2e6);
  EXPECT_TRUE(std::isnan(stand.optional_m));
}

TEST(Document, PrintsValuesThatReadBackTheSame) {
  Stand stand =
      read("levels = [0.1, 0.3]\n[loop]\noptional_m = 1e-7\n[[pump]]\nname = \"a \\\"b\\\"\"\n");
  const std::string text = print_toml([&](Visitor& v) { stand.visit(v); });
  Stand again;
  Document::parse(text, "printed").read([&](Visitor& v) { again.visit(v); });
  EXPECT_EQ(print_toml([&](Visitor& v) { again.visit(v); }), text);
  EXPECT_EQ(again.levels, stand.levels);
  EXPECT_EQ(again.optional_m, 1e-7);
  EXPECT_EQ(again.pumps.at(0).name, "a \"b\"");
  EXPECT_FALSE(again.has_effect);
}

TEST(Document, NamesFileLineTableKeyAndAllowedValues) {
  EXPECT_EQ(message("[loop]\nrate_Hz = 5000\n"),
            "78 stand.toml:3: [loop] rate_Hz: is 5000, out of range; allowed: 1 to 1000");
  EXPECT_EQ(message("[loop]\nmode = \"fast\"\n"),
            "78 stand.toml:3: [loop] mode: is 'fast'; allowed: monitor, control");
  EXPECT_EQ(message("[loop]\nrate_Hz = 20.5\n"),
            "78 stand.toml:3: [loop] rate_Hz: is 20.5; allowed: a whole number");
  EXPECT_EQ(message("[[pump]]\npressure_Pa = 1\n"),
            "78 stand.toml: [pump.0] name: is missing; allowed: what it is called");
  EXPECT_EQ(message("[loop]\nrate_hz = 100\n"),
            "78 stand.toml:3: [loop] rate_hz: is unknown, did you mean rate_Hz?; allowed: mode, "
            "optional_m, rate_Hz");
  EXPECT_THAT(message("levels = [1, 20]\n"), HasSubstr(": levels: is 20, out of range"));
  EXPECT_THAT(message("levels = 1\n"), HasSubstr("an array of numbers"));
  EXPECT_THAT(message("pump = 1\n"), HasSubstr("an array of tables"));
  EXPECT_THAT(message("loop = 1\n"), HasSubstr("a table"));
}

TEST(Document, RefusesNotANumberWhereANumberIsMeant) {
  EXPECT_THAT(message("[loop]\noptional_m = nan\n"), HasSubstr("is nan, out of range"));
}

TEST(Document, RefusesWholeNumbersThatNoDoubleHolds) {
  EXPECT_THAT(message("[loop]\noptional_m = 9223372036854775807\n"),
              HasSubstr("is 9223372036854775807, too large for a whole number"));
  EXPECT_THAT(message("levels = [1, -9007199254740993]\n"), HasSubstr("too large"));
  EXPECT_THAT(message("levels = [9007199254740993]\n"), HasSubstr("too large"));
}

TEST(Document, ShowsTheBeginningOfALongValue) {
  const std::string text = message("[loop]\nmode = \"" + std::string(100'000, 'x') + "\"\n");
  EXPECT_LT(text.size(), 300U);
  EXPECT_THAT(text, HasSubstr("xxx..."));
}

TEST(Document, RefusesTextThatIsNoTomlAndAnotherSchemaVersion) {
  EXPECT_THAT(message("enabled = \n"), HasSubstr("78 stand.toml:2: is not TOML"));
  Stand stand;
  const auto visit = [&](Visitor& v) { stand.visit(v); };
  EXPECT_THROW(Document::parse("schema_version = 2", "x").read(visit), Error);
  EXPECT_THROW(Document::parse("enabled = true", "x").read(visit), Error);
}

TEST(Document, SaysThatAMissingFileCannotBeRead) {
  try {
    Document::load("/nowhere/at/all.toml");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_STREQ(
        e.what(),
        "/nowhere/at/all.toml: cannot be read (No such file or directory); allowed: a TOML file");
  }
  EXPECT_THROW(Document::load("/tmp"), Error);
}

TEST(Document, AssignsSingleValuesFromTheCommandLine) {
  const Stand stand =
      read("[[pump]]\nname = \"p\"\n", {"loop.rate_Hz=100", "loop.mode=control", "enabled=true",
                                        "pump.0.pressure_Pa=5", "levels=[7]", "pump.0.name=q 1"});
  EXPECT_EQ(stand.rate_Hz, 100);
  EXPECT_EQ(stand.mode, "control");
  EXPECT_TRUE(stand.enabled);
  EXPECT_EQ(stand.pumps.at(0).pressure_Pa, 5.0);
  EXPECT_EQ(stand.pumps.at(0).name, "q 1");
  EXPECT_EQ(stand.levels, std::vector<double>{7.0});
}

TEST(Document, RefusesAssignmentsThatNameNothing) {
  EXPECT_THAT(message("", {"loop.rate_Hz"}), HasSubstr("2 --set"));
  EXPECT_THAT(message("", {"=1"}), HasSubstr("2 --set"));
  EXPECT_THAT(message("enabled = true", {"enabled.x=1"}), HasSubstr("78 --set enabled.x"));
  EXPECT_THAT(message("[[pump]]\nname='p'\n", {"pump.3.name=x"}), HasSubstr("78 --set pump.3"));
  for (const char* element : {"x", "1x", "-1", ""}) {
    const std::string assignment = std::string("pump.") + element + ".name=y";
    EXPECT_THAT(message("[[pump]]\nname='p'\n", {assignment.c_str()}),
                HasSubstr(std::string("no element \"") + element + "\"; allowed: 0 to 0"));
  }
  EXPECT_THAT(message("", {"lop.rate_Hz=1"}), HasSubstr("did you mean loop?"));
  EXPECT_THAT(message("", {"loop.rate_Hz=a b"}), HasSubstr("a whole number"));
}

TEST(Document, BlamesTheAssignmentAndNotTheFileForItsValue) {
  EXPECT_THAT(message("", {"loop.rate_Hz=5000"}), HasSubstr("78 --set: [loop] rate_Hz: is 5000"));
  EXPECT_THAT(message("", {"loop.rate_Hz=a b"}), HasSubstr("78 --set: [loop] rate_Hz: is 'a b'"));
  EXPECT_THAT(message("", {"lop.rate_Hz=1"}), HasSubstr("78 --set: lop: is unknown"));
}

/// A table whose keys the file chooses.
struct Stock {
  std::vector<Pump> pumps;
  void visit(Visitor& v) {
    std::vector<std::string> names;
    for (const Pump& pump : pumps) names.push_back(pump.name);
    names = v.names("stock", names);
    pumps.resize(names.size());
    v.table("stock", [&](Visitor& t) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        pumps[i].name = names[i];
        t.table(names[i].c_str(), [&](Visitor& p) {
          p.number("pressure_Pa", pumps[i].pressure_Pa, {0.0, 3e7});
        });
      }
    });
  }
};

TEST(Document, ReadsAndPrintsTablesThatTheFileNamesInItsOrder) {
  const auto read = [](const std::string& text) {
    Stock stock;
    Document::parse("schema_version = 1\n" + text, "s.toml").read([&](Visitor& v) {
      stock.visit(v);
    });
    return stock;
  };
  Stock stock = read("[stock.west]\npressure_Pa = 2e6\n[stock.east]\n");
  ASSERT_EQ(stock.pumps.size(), 2U);
  EXPECT_EQ(stock.pumps[0].name, "west");
  EXPECT_EQ(stock.pumps[0].pressure_Pa, 2e6);
  EXPECT_EQ(stock.pumps[1].name, "east");
  const std::string text = print_toml([&](Visitor& v) { stock.visit(v); });
  EXPECT_NE(text.find("[stock.west]\npressure_Pa = 2e+06\n\n[stock.east]"), std::string::npos);
  EXPECT_TRUE(read("").pumps.empty());
  for (const char* bad : {"stock = 1\n", "[stock]\nwest = 1\n", "[stock.west]\npressure = 1\n"}) {
    try {
      (void)read(bad);
      ADD_FAILURE() << bad;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("stock")) << bad;
    }
  }
}

TEST(Document, RefusesAKeyThatWouldExhaustTheStack) {
  std::string parts;
  for (int i = 0; i < 100'000; ++i) parts += "a.";
  for (const std::string& text : {parts + "b = 1\n", "[" + parts + "b]\n", "[[" + parts + "b]]\n",
                                  "x = {" + parts + "b = 1}\n"}) {
    try {
      (void)Document::parse(text, "deep.toml");
      ADD_FAILURE() << "accepted";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(),
                   "deep.toml: nests a table by a key of too many parts; allowed: up to 64");
    }
  }
  // Dots elsewhere are no parts.
  const std::string dots(200, '.');
  (void)Document::parse("# " + dots + "\n" + "t = \"" + dots + "\"\nn = [0.1, 0.2]\n", "dots.toml");
}

TEST(Error, IsOneLineWhateverAFileSays) {
  EXPECT_STREQ(bad_data("a\nb.csv", "is '\x01\t'", "one\r\n").what(),
               "a b.csv: is '? '; allowed: one? ");
}

}  // namespace
}  // namespace config::schema
