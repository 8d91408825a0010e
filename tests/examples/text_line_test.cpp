// The example backend against a pipe.
#include "examples/backend/text_line.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "config/schema/document.h"
#include "hal/monotonic.h"

namespace {

using config::signals::Quality;

hal::Reading newest(hal::RodSensor& rod) { return rod.read({0, hal::monotonic_ns()}); }

/// Reads until the position is there, for 5 s at most.
hal::Reading wait_for(hal::RodSensor& rod, double y_m) {
  hal::Reading reading = newest(rod);
  for (int i = 0; i < 5000 && reading.y_m != y_m; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    reading = newest(rod);
  }
  return reading;
}

TEST(ExampleBackend, ReadsLinesUntilTheyGrowOld) {
  const std::filesystem::path folder = testing::TempDir();
  const std::filesystem::path pipe = folder / "text_line_pipe";
  std::filesystem::remove(pipe);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  hal::text_line::TextLineBackend backend;
  config::schema::Document::parse("schema_version = 1\ndevice = \"text_line_pipe\"\nsign = -1.0\n",
                                  "t.toml")
      .read([&](config::schema::Visitor& v) { backend.visit(v); });
  hal::Opening opening;
  opening.folder = folder;
  const hal::Offer offer = backend.open(opening);
  hal::RodSensor& rod = *offer.rods.at(hal::kRodChannel);
  EXPECT_EQ(newest(rod).quality, Quality::bad);

  std::ofstream out(pipe);
  out << "305.25\nnoise\n250" << std::flush;  // the last line is not complete
  EXPECT_EQ(wait_for(rod, -0.30525).y_m, -0.30525);
  out << ".5\n" << std::flush;
  EXPECT_EQ(wait_for(rod, -0.2505).y_m, -0.2505);
  const std::int64_t later_ns = hal::monotonic_ns() + 1'000'000'000;
  EXPECT_EQ(rod.read({0, later_ns}).quality, Quality::bad);
}

TEST(ExampleBackend, SaysWhichDeviceIsMissing) {
  hal::text_line::TextLineBackend backend;
  config::schema::Document::parse("schema_version = 1\ndevice = \"/no/such/line\"\n", "t.toml")
      .read([&](config::schema::Visitor& v) { backend.visit(v); });
  try {
    static_cast<void>(backend.open({}));
    FAIL() << "opened";
  } catch (const config::schema::DeviceUnavailable& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("[text_line] device: /no/such/line"));
  }
}

}  // namespace
