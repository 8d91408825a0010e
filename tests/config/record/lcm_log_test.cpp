#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <lcm/lcm-cpp.hpp>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/pressures_t.hpp"
#include "spoolwatch/rods_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "tests/config/record/temporary_file.h"

namespace config::record {
namespace {

using record_test::TemporaryFile;
using spoolwatch::sample_t;

class LcmLog : public testing::Test {
 protected:
  template <class T>
  void write(const std::string& channel, const T& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    lcm::LogEvent event{};
    event.eventnum = written_++;
    event.timestamp = 1000 * event.eventnum;
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(bytes.size());
    event.data = bytes.data();
    log_->writeEvent(&event);
  }
  void write_samples(
      const std::string& channel, int count,
      const std::function<void(int, sample_t&)>& change = [](int, sample_t&) {}) {
    for (int i = 0; i < count; ++i) {
      sample_t s{};
      s.tick = i;
      s.sample_time_s = 0.005;
      s.u_applied_V = 0.5 * i;
      s.y_m = 0.3 + 0.001 * i;
      s.reference_m = 0.4;
      change(i, s);
      write(channel, s);
    }
  }
  Record read() {
    log_.reset();  // closes it
    return read_record(file_.path());
  }
  void expect_bad(const std::string& part) {
    try {
      (void)read();
      ADD_FAILURE() << "accepted";
    } catch (const schema::DataError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }

  TemporaryFile file_{"", ".log"};
  std::unique_ptr<lcm::LogFile> log_ = std::make_unique<lcm::LogFile>(file_.path(), "w");
  std::int64_t written_ = 0;
};

TEST_F(LcmLog, IsRecognisedByContentAndReadInSiUnits) {
  write("SPOOLWATCH_HEALTH", spoolwatch::health_t{});
  write_samples("SPOOLWATCH_SAMPLE", 5);
  const Record record = read();
  EXPECT_EQ(record.size(), 5U);
  EXPECT_EQ(record.sample_time_s, 0.005);
  EXPECT_DOUBLE_EQ(record.t_s[3], 0.015);
  EXPECT_DOUBLE_EQ(record.u_V[3], 1.5);
  EXPECT_DOUBLE_EQ(record.y_m[3], 0.303);
  EXPECT_DOUBLE_EQ(record.column("reference_m")->at(3), 0.4);
  EXPECT_TRUE(record.notes.empty());
}

TEST_F(LcmLog, FindsTheSamplesUnderAnotherPrefix) {
  write("RIG2_HEALTH", spoolwatch::health_t{});
  write_samples("RIG2_SAMPLE", 5);
  EXPECT_EQ(read().size(), 5U);
}

TEST_F(LcmLog, GivesPressuresAsColumnsOfTheSamplesThatTheyBelongTo) {
  write_samples("SPOOLWATCH_SAMPLE", 8, [this](int i, sample_t& s) {
    spoolwatch::pressures_t p{};
    p.tick = i == 6 ? 5 : i;    // that of sample 6 is lost: only an old one is there
    p.run_id = i == 7 ? 1 : 0;  // of another run
    p.supply_Pa = 7e6 + i;
    p.in_Pa = i == 4 ? std::nan("") : 4e6 + i;
    p.out_Pa = 2e6 + i;
    if (i >= 2) write("SPOOLWATCH_PRESSURES", p);
    if (i == 3) s.quality = 3;
  });
  const Record record = read();
  ASSERT_EQ(record.size(), 7U);
  EXPECT_EQ(record.further.size(), 8U);
  const double nan = std::nan("");
  const double supply_Pa[] = {nan, nan, 7e6 + 2, 7e6 + 4, 7e6 + 5, nan, nan};
  const double in_Pa[] = {nan, nan, 4e6 + 2, nan, 4e6 + 5, nan, nan};
  for (std::size_t i = 0; i < 7; ++i) {
    const double supply = record.column("supply_pressure_Pa")->at(i);
    const double in = record.column("pressure_in_Pa")->at(i);
    const double out = record.column("pressure_out_Pa")->at(i);
    EXPECT_TRUE(supply == supply_Pa[i] || (std::isnan(supply) && std::isnan(supply_Pa[i]))) << i;
    EXPECT_TRUE(in == in_Pa[i] || (std::isnan(in) && std::isnan(in_Pa[i]))) << i;
    EXPECT_TRUE(out == supply_Pa[i] - 5e6 || (std::isnan(out) && std::isnan(supply_Pa[i]))) << i;
  }
}

TEST_F(LcmLog, GivesEveryRodSensorAsAColumn) {
  write_samples("RIG2_SAMPLE", 4, [this](int i, sample_t&) {
    spoolwatch::rods_t rods{};
    rods.tick = i;
    rods.in_charge = static_cast<std::int8_t>(i / 2);
    rods.count = 2;
    rods.rod = {"rod", "outer"};
    rods.y_m = {0.3 + 0.001 * i, i == 1 ? std::nan("") : 0.4};
    rods.quality = {0, 0};
    rods.fault = {0, 0};
    write("RIG2_RODS", rods);
    write("OTHER_RODS", rods);
  });
  const Record record = read();
  ASSERT_EQ(record.size(), 4U);
  EXPECT_EQ(*record.column("rod_in_charge"), (std::vector<double>{1.0, 1.0, 2.0, 2.0}));
  EXPECT_EQ(*record.column("rod_1_m"), record.y_m);
  EXPECT_TRUE(std::isnan(record.column("rod_2_m")->at(1)));
  EXPECT_EQ(record.column("rod_2_m")->at(2), 0.4);
}

TEST_F(LcmLog, RefusesPressuresOfAnotherType) {
  write_samples("SPOOLWATCH_SAMPLE", 3);
  write("SPOOLWATCH_PRESSURES", spoolwatch::health_t{});
  expect_bad("event 3: on SPOOLWATCH_PRESSURES is of another type");
}

TEST_F(LcmLog, LeavesBadSamplesOutAsGapsAndSaysSo) {
  write_samples("SPOOLWATCH_SAMPLE", 40, [](int i, sample_t& s) {
    if (i == 10) s.quality = 3;
    if (i == 30) s.quality = 2;
    if (i == 35) s.quality = 1;  // uncertain is kept
    if (i == 20) s.y_m = std::nan("");
  });
  const Record record = read();
  EXPECT_EQ(record.size(), 37U);
  EXPECT_EQ(record.gaps, (std::vector<std::size_t>{10, 19, 28}));
  ASSERT_EQ(record.notes.size(), 1U);
  EXPECT_NE(record.notes[0].find("3 samples"), std::string::npos);
}

TEST_F(LcmLog, UsesTheCompleteEventsOfALogCutOffAndSaysSo) {
  write_samples("SPOOLWATCH_SAMPLE", 10);
  log_.reset();
  std::filesystem::resize_file(file_.path(), std::filesystem::file_size(file_.path()) - 20);
  const Record record = read();
  EXPECT_EQ(record.size(), 9U);
  ASSERT_EQ(record.notes.size(), 1U);
  EXPECT_NE(record.notes[0].find("cut off"), std::string::npos);
}

/// liblcm's reader allocates what a damaged length asks for, and ends the program.
TEST_F(LcmLog, StopsAtADamagedLength) {
  write_samples("SPOOLWATCH_SAMPLE", 10);
  log_.reset();
  const auto event_bytes = std::filesystem::file_size(file_.path()) / 10;
  for (const int length_at : {20, 24}) {  // of the channel, of the data
    std::fstream damaged(file_.path(), std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekp(static_cast<std::streamoff>(event_bytes) * (length_at == 20 ? 7 : 5) + length_at);
    damaged.write("\x7F\xFF\xFF\xFF", 4);
    damaged.close();
    const Record record = read();
    EXPECT_EQ(record.size(), length_at == 20 ? 7U : 5U);
    ASSERT_EQ(record.notes.size(), 1U);
    EXPECT_NE(record.notes[0].find("cut off"), std::string::npos);
  }
}

TEST_F(LcmLog, RefusesALogOfAnotherType) {
  write("SPOOLWATCH_HEALTH", spoolwatch::health_t{});
  expect_bad("no events of type spoolwatch::sample_t");
}

TEST_F(LcmLog, RefusesAnotherTypeOnTheSampleChannel) {
  write_samples("SPOOLWATCH_SAMPLE", 3);
  write("SPOOLWATCH_SAMPLE", spoolwatch::health_t{});
  expect_bad("event 3: on SPOOLWATCH_SAMPLE is of another type");
}

TEST_F(LcmLog, RefusesAPositionThatNoMachineHas) {
  write_samples("SPOOLWATCH_SAMPLE", 10, [](int i, sample_t& s) {
    if (i == 5) s.y_m = -1e300;
  });
  expect_bad("event 5: y_m is -1e+300; allowed: magnitudes up to 1e+06 m");
}

TEST_F(LcmLog, RefusesTwoRunsInOneRecord) {
  write_samples("SPOOLWATCH_SAMPLE", 5, [](int i, sample_t& s) { s.run_id = i / 3; });
  expect_bad("another run");
}

TEST_F(LcmLog, RefusesTicksThatGoBack) {
  write_samples("SPOOLWATCH_SAMPLE", 5, [](int i, sample_t& s) { s.tick = i == 3 ? 1 : i; });
  expect_bad("event 3: time does not increase");
}

TEST_F(LcmLog, RefusesALogWithoutAGoodSample) {
  write_samples("SPOOLWATCH_SAMPLE", 5, [](int, sample_t& s) { s.u_applied_V = std::nan(""); });
  expect_bad("no sample with a good position and command");
}

TEST_F(LcmLog, RefusesALogCutOffInItsFirstEvent) {
  write_samples("SPOOLWATCH_SAMPLE", 1);
  log_.reset();
  std::filesystem::resize_file(file_.path(), 40);
  expect_bad("no complete event");
}

}  // namespace
}  // namespace config::record
