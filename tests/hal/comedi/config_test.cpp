#include <gmock/gmock.h>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/comedi/comedi.h"

namespace hal::comedi {
namespace {

using config::schema::ConfigError;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// The complaint about the table, in one line.
std::string complaint(const std::string& text) {
  ComediBackend backend;
  try {
    config::schema::Document::parse("schema_version = 1\n" + text, "rig.toml").read([&](auto& v) {
      backend.visit(v);
    });
    (void)backend.open({"rig.toml", ".", 0.005, 0.0});
  } catch (const ConfigError& e) {
    EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
    return e.what();
  }
  return "nothing";
}

TEST(ComediBackend, RefusesABoardThatThereIsNot) {
  try {
    complaint("device = \"/dev/comedi_none\"\n");
    FAIL() << "accepted";
  } catch (const config::schema::DeviceUnavailable& e) {
    EXPECT_THAT(e.what(),
                AllOf(HasSubstr("rig.toml: [comedi] device"), HasSubstr("/dev/comedi_none"),
                      HasSubstr("no such device"), HasSubstr("allowed")));
  }
}

TEST(ComediBackend, RefusesTablesThatCannotBe) {
  EXPECT_THAT(complaint("[output]\npolarity = 0\n"), HasSubstr("[comedi.output] polarity"));
  EXPECT_THAT(complaint("[rod]\nkind = \"counter\"\n"),
              AllOf(HasSubstr("[comedi.rod] resolution_m"), HasSubstr("is missing")));
  EXPECT_THAT(complaint("[rod]\nscale_m_per_V = 0.0\n"),
              AllOf(HasSubstr("[comedi.rod] scale_m_per_V"), HasSubstr("is 0")));
  EXPECT_THAT(complaint("[rod]\nkind = \"potentiometer\"\n"), HasSubstr("analog, counter"));
  EXPECT_THAT(complaint("[[input]]\nname = \"p\"\n[[input]]\nname = \"p\"\n"),
              HasSubstr("\"p\" twice"));
  EXPECT_THAT(complaint("[output]\nsubdevise = 1\n"), HasSubstr("subdevice"));
}

TEST(ComediBackend, IsHarmlessOnlyWithoutAnOutputOrOnABench) {
  const auto harmless = [](const std::string& text) {
    ComediBackend backend;
    config::schema::Document::parse("schema_version = 1\n" + text, "rig.toml").read([&](auto& v) {
      backend.visit(v);
    });
    return backend.harmless();
  };
  EXPECT_TRUE(harmless("[[input]]\nname = \"p\"\n"));
  EXPECT_FALSE(harmless("[output]\nchannel = 0\n"));
  EXPECT_TRUE(harmless("bench_rig = true\n[output]\nchannel = 0\n"));
}

}  // namespace
}  // namespace hal::comedi
