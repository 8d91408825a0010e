// The shipped stand with real devices: its file is read by the same fields that open them.
#include <gmock/gmock.h>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/rig.h"

namespace hal {
namespace {

constexpr const char* kFile = SPOOLWATCH_SOURCE_DIR "/config/stand_gpio_comedi.toml";

TEST(ShippedStand, IsReadAndStatesItsPermittedSpeed) {
  Rig rig;
  config::schema::Document::load(kFile).read_part([&](auto& v) { rig.visit(v); });
  EXPECT_FALSE(rig.harmless());
  EXPECT_TRUE(std::isnan(rig.null_times().process_dead_s)) << "a D/A converter holds its code";
  EXPECT_TRUE(rig.has_permit());
  // 20000 edges a second of 5 um each.
  EXPECT_THAT(rig.notes({}), ::testing::Contains(::testing::HasSubstr("permitted speed 0.1 m/s")));
}

TEST(ShippedStand, IsRefusedInOneLineWhereItsBoardsAreNot) {
  Rig rig;
  config::schema::Document document = config::schema::Document::load(kFile);
  document.set("encoder.chip=/dev/gpiochip_none");
  document.read_part([&](auto& v) { rig.visit(v); });
  try {
    (void)rig.open({"stand.toml", ".", 0.005, 0.0, 9.0});
    FAIL() << "opened";
  } catch (const config::schema::DeviceUnavailable& e) {
    EXPECT_THAT(e.what(), ::testing::Not(::testing::HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace hal
