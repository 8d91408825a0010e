// The shipped daemon on the bench rig, with guards as wanted, and what watches the rig.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "hal/hil_rig/server.h"
#include "hal/monotonic.h"
#include "tests/daemon/program/bench_watch.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/hal/hil_rig/rig_process.h"

namespace program {

/// A command that is far from null, and moves the rod by some decimetres a second.
inline constexpr double kFar_V = 3.0;

inline constexpr const char* kGuards = R"(
[safety]
ramp_s = 0.1

[[guard]]
kind = "jump"
limit_m = 0.008
action = "latch"

[[guard]]
kind = "frozen"
least_m = 5e-5
command_V = 1.0
time_s = 0.05
action = "ramp"
)";

// One at a time: none of the others may come first.
inline constexpr const char* kTravel = R"(
[[guard]]
kind = "travel"
low_m = 0.2
high_m = 0.42
action = "latch"
)";
inline constexpr const char* kSpeed = R"(
[[guard]]
kind = "speed"
limit_mps = 1.0
action = "latch"
)";
inline constexpr const char* kFollowing = R"(
[[guard]]
kind = "following"
limit_m = 0.08
time_s = 0.02
action = "latch"
)";
inline constexpr const char* kStale = R"(
[safety]
ramp_s = 0.1
[[guard]]
kind = "stale"
age_s = 0.01
action = "latch"
)";
inline constexpr const char* kOverrun = R"(
[safety]
ramp_s = 0.1
[[guard]]
kind = "overrun"
action = "latch"
)";
inline constexpr const char* kEStop = R"(
[[guard]]
kind = "e_stop"
action = "latch"
)";
inline constexpr const char* kEnable = R"(
[modbus.registers.enable]
role = "input"
address = 12
[[input]]
id = "enable"
role = "enable"
backend = "modbus"
channel = "enable"
)";

// The supply pressure as an input; keys of its register may follow.
inline const std::string kSupply =
    "\n"
    R"([[input]]
id = "supply"
role = "supply_pressure"
backend = "modbus"
channel = "supply"
[modbus.registers.supply]
role = "input"
address = 15
type = "int16"
scale = 1000.0
)";
inline const std::string kPressure = kSupply + R"(
[[guard]]
kind = "pressure"
channel = "supply_pressure"
low_Pa = 5e6
action = "latch"
)";
// The same pressure with a range, below which there is none.
inline const std::string kTransducer = kSupply + R"(
low = 5e6
high = 1e7
[[guard]]
kind = "transducer"
channel = "supply_pressure"
action = "latch"
)";
// The register of the enable input, which a test can set, in the part of a chamber's transducer.
inline const std::string kChambers = kSupply + R"(
[modbus.registers.chamber]
role = "input"
address = 12
scale = -2e7
offset = 2e7
[modbus.registers.other_chamber]
role = "input"
address = 17
type = "int16"
scale = 1000.0
[[input]]
id = "chamber"
role = "pressure_in"
backend = "modbus"
channel = "chamber"
[[input]]
id = "other_chamber"
role = "pressure_out"
backend = "modbus"
channel = "other_chamber"
[[guard]]
kind = "chambers"
tolerance_Pa = 5e5
action = "latch"
)";
// The same register, in the part of a second position sensor.
inline constexpr const char* kDisagree = R"(
[modbus.registers.spare]
role = "rod"
address = 12
scale = 0.2
offset = 0.105
[[spare_rod]]
id = "spare"
backend = "modbus"
channel = "spare"
[[guard]]
kind = "disagree"
tolerance_m = 0.12
action = "latch"
)";
inline constexpr const char* kSaturated = R"(
[[guard]]
kind = "saturated"
time_s = 0.05
action = "latch"
)";

inline constexpr const char* kPermit = R"(
[permit]
backend = "modbus"
channel = "permit"

[modbus.registers.permit]
role = "output"
function = "coil"
address = 0
)";

/// bench_modbus.toml with more, and the shipped daemon on it.
class Bench {
 public:
  explicit Bench(const std::string& more = kGuards)
      : rig_({"--config", hal::hil_rig::shipped_config("bench_rig.toml")}),
        cable_(rig_.port()),
        watcher_(rig_.port()) {
    std::ifstream in(shipped("bench_modbus.toml"));
    std::ofstream(file()) << in.rdbuf() << more;
  }

  [[nodiscard]] std::vector<std::string> arguments(bool by_cable = false) const {
    return {"--config",  file(),
            "--lcm-url", "",
            "--set",     "modbus.address=" + (by_cable ? cable_.address() : rig_.address()),
            "--set",     "reference.amplitude_m=0.05",
            "--set",     "reference.frequency_Hz=1.0"};
  }
  [[nodiscard]] std::string file() const { return (folder_.path() / "bench.toml").string(); }
  /// Until the valve is far from null, and on its way out.
  bool moves() {
    return watcher_.wait_for([](const Look& look) { return look.valve_V > kFar_V; });
  }
  void set(const std::string& text) const {
    EXPECT_EQ(hal::hil_rig::set_remotely(rig_.address(), text), "");
  }
  /// The rig's register of that name, read on a connection of its own.
  [[nodiscard]] int status() const {
    modbus_t* bus = modbus_new_tcp("127.0.0.1", rig_.port());
    std::uint16_t word = 0;
    const bool read = modbus_connect(bus) == 0 &&
                      modbus_read_registers(bus, hal::hil_rig::kStatus, 1, &word) == 1;
    modbus_close(bus);
    modbus_free(bus);
    return read ? word : 0;
  }
  Watcher& watcher() { return watcher_; }
  Cable& cable() { return cable_; }

 private:
  Folder folder_;
  hal::hil_rig::RigProcess rig_;
  Cable cable_;
  Watcher watcher_;
};

}  // namespace program
