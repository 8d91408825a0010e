// The loop on the simulated rig in virtual time, with one failure, watched from outside.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "config/schema/document.h"
#include "daemon/null_table.h"
#include "daemon/rt/loop.h"
#include "hal/rig.h"
#include "hal/sim/sim.h"

namespace monitor {

inline constexpr double kTs_s = 0.005;
inline constexpr std::int64_t kPeriod_ns = 5'000'000;
inline constexpr double kLimit_V = 4.0;
inline constexpr double kNull_V = 0.25;
/// Times of the grid are exact to far better than this.
inline constexpr double kRounding_s = 1e-6;

/// One tick as an observer outside sees it.
struct Seen {
  double t_s;
  double valve_V;  ///< held from the tick before to this one
  double rod_m;    ///< true
  config::signals::Sample sample;
};

inline std::string pressure_input(const std::string& role) {
  return "[[input]]\nid = \"" + role + "\"\nrole = \"" + role +
         "\"\nbackend = \"sim\"\nchannel = \"" + role + "\"\n";
}

inline std::string rig_toml(const std::string& more) {
  return "schema_version = 1\n[rod]\nbackend = \"sim\"\n"
         "[[spare_rod]]\nid = \"second\"\nbackend = \"sim\"\nchannel = \"second\"\n"
         "[valve]\nbackend = \"sim\"\nnull_V = 0.25\nlimit_V = 4.0\n"
         "[[input]]\nid = \"stop\"\nrole = \"e_stop\"\nbackend = \"sim\"\nchannel = \"stop\"\n"
         "[[input]]\nid = \"enable\"\nrole = \"enable\"\nbackend = \"sim\"\nchannel = "
         "\"enable\"\n" +
         pressure_input("supply_pressure") + pressure_input("pressure_in") +
         pressure_input("pressure_out") +
         "[permit]\nbackend = \"sim\"\n"
         "[sim]\nmodel = \"" SPOOLWATCH_SOURCE_DIR
         "/config/models/thesis_calibrated.toml\"\nnoise_m = 2e-6\npretend_real = true\n"
         "command_timeout_s = 0.1\n" +
         more;
}

inline std::string input(const char* id, double from_s) {
  return std::string("[[sim.input]]\nid = \"") + id + "\"\nfrom_s = " + std::to_string(from_s) +
         "\n";
}

inline std::string trouble(const char* kind, double from_s) {
  return std::string("[[sim.trouble]]\nkind = \"") + kind +
         "\"\nfrom_s = " + std::to_string(from_s) +
         (std::string(kind) == "jump" ? "\nsize_m = 0.02\n" : "\n");
}

/// A transducer of the simulated rig that reads so much more from then on.
inline std::string wrong_pressure(const char* of, double offset_Pa, double from_s) {
  return std::string("[[sim.pressure]]\nof = \"") + of +
         "\"\noffset_Pa = " + std::to_string(offset_Pa) + "\nfrom_s = " + std::to_string(from_s) +
         "\n";
}

inline constexpr double kNever_s = 1e6;

/// The events of one run.
struct Plan {
  std::string row;  ///< in the table
  std::string troubles;
  double e_stop_s = kNever_s;
  double enable_s = kNever_s;
  double spare_off_s = kNever_s;
  double close_s = kNever_s;
  double stall_s = kNever_s;
  int stall_periods = 0;
  std::string guard;  ///< kind, "" for none but the built-in ones
  std::string action = "latch";
  /// True for a tick that belongs to the failure; without one it begins at at_s.
  std::function<bool(const Seen& before, const Seen& now)> failing;
  double at_s = 0.0;
};

inline control::GuardConfig guard_of(const std::string& kind, const std::string& action) {
  control::GuardConfig guard;
  guard.id = guard.kind = kind;
  guard.action = action;
  guard.high_m = 0.33;
  guard.limit_m = kind == "jump" ? 5e-3 : 0.03;
  guard.limit_mps = 0.12;
  guard.age_s = 1.0;
  guard.least_m = 1e-4;
  guard.command_V = 0.2;
  guard.tolerance_m = 1e-3;
  guard.channel = "supply_pressure";
  guard.low_Pa = 3e6;  // the supply is at 6.9 MPa
  guard.tolerance_Pa = 1e6;
  if (kind == "frozen" || kind == "saturated") guard.time_s = 0.05;
  if (kind == "following") guard.time_s = 0.02;
  return guard;
}

/// The loop on the simulated rig in virtual time, watched from outside.
class Stand {
 public:
  explicit Stand(const Plan& plan) : plan_(plan), reference_(0.305, 0.04, 0.6) {
    config::schema::Document::parse(
        rig_toml(plan.troubles + input("stop", plan.e_stop_s) + input("enable", plan.enable_s) +
                 "[[sim.rod]]\nid = \"second\"\noffset_m = 0.002\nfrom_s = " +
                 std::to_string(plan.spare_off_s) + "\n[[sim.rod]]\nid = \"truth\"\n"),
        "rig.toml")
        .read([&](config::schema::Visitor& v) { rig_.visit(v); });
    devices_ = rig_.open(opening_);
    rules_.safety.blend_s = 0.5;
    rules_.safety.blend_mps = 1.0;
    rules_.safety.ramp_s = 0.1;
    if (!plan.guard.empty()) rules_.safety.guards = {guard_of(plan.guard, plan.action)};
    config_.max_lost_in_a_row = plan.guard == "overrun" ? 2 : 1000;
    config_.max_lost_a_minute = 1000;
  }

  std::vector<NullRow> stated() {
    return null_rows({"sim", rig_.null_times(), kTs_s, 1.0, rules_.safety.ramp_s,
                      config_.max_bad_in_a_row,
                      control::all_guards(rules_.safety, config_.overrun()), true, true, true});
  }
  double speed_mps() { return rig_.worst_speed_mps(opening_); }

  std::vector<Seen> run() {
    rt::VirtualClock clock;
    rt::SampleQueue samples;
    rt::CommandQueue commands;
    rt::LoopStats stats;
    Watched rod{*devices_.rod, dynamic_cast<hal::sim::SimRig&>(*devices_.rod), seen_};
    rt::Loop loop(config_,
                  {clock, rod, devices_.valve.get(), reference_, samples, commands, stats,
                   &devices_.spare_rods, &devices_.inputs, devices_.permit.get()},
                  control::Controller({150.0}, {kNull_V, kLimit_V}, kTs_s), kTs_s, rules_);
    rt::Grid grid(0, kPeriod_ns);
    for (const control::Event event : {control::Event::arm, control::Event::start}) {
      rt::LoopCommand command;
      command.event = event;
      command.expires_ns = INT64_MAX;
      commands.push(command);
    }
    for (int n = 0; n < 800; ++n) {
      const double t_s = static_cast<double>(clock.now_ns()) * 1e-9;
      if (t_s >= plan_.close_s) loop.close();
      if (t_s >= plan_.stall_s) {
        stall(rod, grid.index());
        clock.advance_ns(plan_.stall_periods * kPeriod_ns + 1);
        plan_.stall_s = kNever_s;
      }
      loop.tick(grid.next(clock));
      while (samples.pop(seen_.back().sample)) {
      }
    }
    return std::move(seen_);
  }

 private:
  struct Watched final : hal::RodSensor {
    Watched(hal::RodSensor& in, const hal::sim::SimRig& rig, std::vector<Seen>& seen)
        : inner(in), plant(rig), all(seen) {}
    hal::Reading read(const hal::Tick& tick) noexcept override {
      const hal::Reading reading = inner.read(tick);
      all.push_back(
          {static_cast<double>(tick.nominal_ns) * 1e-9, reading.command_V, plant.position_m(), {}});
      return reading;
    }
    hal::RodSensor& inner;
    const hal::sim::SimRig& plant;
    std::vector<Seen>& all;
  };

  /// The plant goes on while the loop does not.
  void stall(Watched& rod, std::int64_t next) const {
    for (int k = 0; k < plan_.stall_periods; ++k) {
      rod.read({next + k, (next + k) * kPeriod_ns});
      rod.all.back().sample = rod.all[rod.all.size() - 2].sample;
    }
  }

  Plan plan_;
  control::Sine reference_;
  hal::Rig rig_;
  hal::OpenContext opening_{"rig.toml", SPOOLWATCH_SOURCE_DIR "/config", kTs_s, kNull_V};
  hal::Devices devices_;
  rt::LoopConfig config_;
  rt::SafetyRules rules_;
  std::vector<Seen> seen_;
};

struct Measured {
  double time_s = std::nan("");
  double travel_m = 0.0;
};

}  // namespace monitor
