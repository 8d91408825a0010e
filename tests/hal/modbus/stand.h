// A Modbus backend opened from TOML text, and a loop's turn on it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <thread>

#include "config/schema/document.h"
#include "config/schema/error.h"
#include "hal/modbus/modbus.h"
#include "hal/monotonic.h"

namespace hal::modbus {

/// Slow enough for a machine that has other things to do.
inline constexpr double kPeriod_s = 0.02;

inline BackendDevices open_text(const std::string& text, double null_V = 0.0) {
  ModbusBackend backend;
  config::schema::Document::parse("schema_version = 1\n[modbus]\n" + text, "stand.toml")
      .read([&](config::schema::Visitor& v) {
        v.table({"modbus"}, [&](config::schema::Visitor& t) { backend.visit(t); });
      });
  return backend.open({"stand.toml", {}, kPeriod_s, null_V});
}

/// The backend's message when it refuses that text; "accepted" when it does not.
inline std::string refusal_of(const std::string& text, double null_V = 0.0, int exit_code = 78) {
  try {
    (void)open_text(text, null_V);
  } catch (const config::schema::Error& e) {
    EXPECT_EQ(config::schema::exit_code_of(e), exit_code);
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << "more than one line";
    return e.what();
  }
  return "accepted";
}

/// True as soon as `condition` holds; false after ten seconds.
inline bool eventually(const std::function<bool()>& condition) {
  for (int i = 0; i < 2000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

class Stand {
 public:
  explicit Stand(const std::string& text, double null_V = 0.0)
      : devices_(open_text(text, null_V)) {}

  /// One period: reads, writes, waits for the next.
  Reading turn(double u_V) {
    const Reading reading = read();
    applied_ = devices_.valve->write(u_V, {tick_, nominal_ns()});
    std::this_thread::sleep_for(std::chrono::duration<double>(kPeriod_s));
    return reading;
  }
  Reading read() { return devices_.rods.at("position")->read({++tick_, nominal_ns()}); }
  [[nodiscard]] const Applied& applied() const noexcept { return applied_; }
  [[nodiscard]] BackendDevices& devices() noexcept { return devices_; }

  /// Turns until a reading has that quality; false when none has in ten seconds.
  bool turn_until(config::signals::Quality quality, double u_V) {
    for (int i = 0; i < 500; ++i) {
      if (turn(u_V).quality == quality) return true;
    }
    return false;
  }

 private:
  /// Its periods are as long as the machine makes them.
  [[nodiscard]] std::int64_t nominal_ns() const { return monotonic_ns() - start_ns_; }

  BackendDevices devices_;
  std::int64_t start_ns_ = monotonic_ns();
  std::int64_t tick_ = 0;
  Applied applied_;
};

}  // namespace hal::modbus
