#include <gmock/gmock.h>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/encoder/encoder.h"

namespace hal::encoder {
namespace {

using config::schema::ConfigError;
using config::schema::Document;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kTable =
    "schema_version = 1\nchip = \"/dev/gpiochip_none\"\nline_a = 3\nline_b = 4\n"
    "resolution_m = 5e-5\n";

EncoderConfig read(const std::string& text) {
  EncoderConfig config;
  Document::parse(text, "rig.toml").read([&](auto& v) { config.visit(v); });
  return config;
}

/// The complaint about the table and further lines; "": none.
std::string complaint(const std::string& more, const std::string& table = kTable) {
  try {
    read(table + more).check("rig.toml");
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(EncoderConfig, AcceptsTheShortestTable) { EXPECT_EQ(complaint(""), ""); }

TEST(EncoderConfig, RefusesWhatCannotBe) {
  EXPECT_THAT(complaint("counts_per_metre = 20000.0"), HasSubstr("is given together with"));
  EXPECT_THAT(complaint("", "schema_version = 1\nchip = \"x\"\nline_a = 3\nline_b = 4\n"),
              AllOf(HasSubstr("[encoder] resolution_m"), HasSubstr("is missing")));
  EXPECT_THAT(complaint("sign = 0"), AllOf(HasSubstr("[encoder] sign"), HasSubstr("1 or -1")));
  EXPECT_THAT(complaint("line_index = 4"),
              AllOf(HasSubstr("line_index"), HasSubstr("the line of line_b")));
  EXPECT_THAT(complaint("[[input]]\nname = \"stop\"\nline = 3\n"),
              AllOf(HasSubstr("\"stop\" line"), HasSubstr("the line of line_a")));
  EXPECT_THAT(complaint("[[input]]\nname = \"stop\"\nline = 7\n[[input]]\nname = \"stop\"\n"
                        "line = 8\n"),
              HasSubstr("\"stop\" twice"));
  EXPECT_THAT(complaint("mode = \"x3\""), HasSubstr("x1, x2, x4"));
}

TEST(EncoderConfig, StatesThePermittedSpeedOfTheConfiguredResolution) {
  const EncoderConfig x4 = read(std::string(kTable) + "max_edges_per_s = 10000.0");
  EXPECT_DOUBLE_EQ(x4.permitted_speed_mps(), 0.5) << "an edge each 50 um";
  const EncoderConfig x1 = read(std::string(kTable) + "max_edges_per_s = 10000.0\nmode = \"x1\"");
  EXPECT_DOUBLE_EQ(x1.permitted_speed_mps(), 0.125) << "four edges each 50 um";
  const EncoderConfig per_metre = read(
      "schema_version = 1\nchip = \"x\"\nline_a = 3\nline_b = 4\ncounts_per_metre = 20000.0\n"
      "max_edges_per_s = 10000.0");
  EXPECT_DOUBLE_EQ(per_metre.permitted_speed_mps(), 0.5);
}

TEST(EncoderConfig, RefusesASpeedTooNearThePermittedOne) {
  EXPECT_EQ(complaint("max_edges_per_s = 10000.0\nmax_speed_mps = 0.39"), "");
  EXPECT_THAT(complaint("max_edges_per_s = 10000.0\nmax_speed_mps = 0.41"),
              AllOf(HasSubstr("8200 edges"), HasSubstr("0.4")));
}

TEST(EncoderBackend, NotesThePermittedSpeed) {
  EncoderBackend backend;
  Document::parse(std::string(kTable) + "max_edges_per_s = 10000.0", "rig.toml").read([&](auto& v) {
    backend.visit(v);
  });
  EXPECT_THAT(backend.notes({}),
              ::testing::ElementsAre(AllOf(HasSubstr("50 um per count (x4)"),
                                           HasSubstr("permitted speed 0.5 m/s"),
                                           HasSubstr("uncertain from 0.4 m/s"))));
}

TEST(EncoderBackend, RefusesAChipThatThereIsNot) {
  EncoderBackend backend;
  Document::parse(kTable, "rig.toml").read([&](auto& v) { backend.visit(v); });
  try {
    const BackendDevices devices = backend.open({"rig.toml", ".", 0.005, 0.0});
    FAIL() << "opened";
  } catch (const config::schema::DeviceUnavailable& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("rig.toml: [encoder] chip"),
                                HasSubstr("/dev/gpiochip_none"), HasSubstr("allowed")));
  }
}

}  // namespace
}  // namespace hal::encoder
