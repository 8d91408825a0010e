// Every failure on the simulated rig, measured: how long the valve keeps a command of the law, how
// far the rod travels meanwhile; never worse than `--check` states. Prints the same table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "config/schema/document.h"
#include "daemon/null_table.h"
#include "daemon/rt/loop.h"
#include "hal/roles.h"
#include "hal/sim/sim.h"

namespace monitor {
namespace {

constexpr double kTs_s = 0.005;
constexpr std::int64_t kPeriod_ns = 5'000'000;
constexpr double kLimit_V = 4.0;
constexpr double kTimeout_s = 0.1;
constexpr double kNull_V = 0.25;
/// Times of the grid are exact to far better than this.
constexpr double kRounding_s = 1e-6;

/// One tick as an observer outside sees it.
struct Seen {
  double t_s;
  double valve_V;  ///< held from the tick before to this one
  double rod_m;    ///< true
  estimator::fdi::Sample sample;
};

std::string rig_toml(const std::string& more) {
  return "schema_version = 1\n[rod]\nbackend = \"sim\"\n"
         "[[spare_rod]]\nid = \"second\"\nbackend = \"sim\"\nchannel = \"second\"\n"
         "[valve]\nbackend = \"sim\"\nnull_V = 0.25\nlimit_V = 4.0\n"
         "[[input]]\nid = \"stop\"\nrole = \"e_stop\"\nbackend = \"sim\"\nchannel = \"stop\"\n"
         "[[input]]\nid = \"enable\"\nrole = \"enable\"\nbackend = \"sim\"\nchannel = \"enable\"\n"
         "[permit]\nbackend = \"sim\"\n"
         "[sim]\nmodel = \"" SPOOLWATCH_SOURCE_DIR
         "/config/models/thesis_calibrated.toml\"\nnoise_m = 2e-6\npretend_real = true\n"
         "command_timeout_s = 0.1\n" +
         more;
}

std::string input(const char* id, double from_s) {
  return std::string("[[sim.input]]\nid = \"") + id + "\"\nfrom_s = " + std::to_string(from_s) +
         "\n";
}

std::string trouble(const char* kind, double from_s) {
  return std::string("[[sim.trouble]]\nkind = \"") + kind +
         "\"\nfrom_s = " + std::to_string(from_s) +
         (std::string(kind) == "jump" ? "\nsize_m = 0.02\n" : "\n");
}

constexpr double kNever_s = 1e6;

/// What happens in one run.
struct Plan {
  std::string row;  ///< of the table
  std::string troubles;
  double e_stop_s = kNever_s;
  double enable_s = kNever_s;
  double spare_off_s = kNever_s;
  double close_s = kNever_s;
  double stall_s = kNever_s;
  int stall_periods = 0;
  std::string guard;  ///< kind, "" for none but the built-in ones
  std::string action = "latch";
  /// Whether a tick belongs to the failure; without one it begins at at_s.
  std::function<bool(const Seen& before, const Seen& now)> failing;
  double at_s = 0.0;
};

control::GuardConfig guard_of(const std::string& kind, const std::string& action) {
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
      rt::Command command;
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
  hal::Opening opening_{"rig.toml", SPOOLWATCH_SOURCE_DIR "/config", kTs_s, kNull_V};
  hal::Devices devices_;
  rt::LoopConfig config_;
  rt::SafetyRules rules_;
  std::vector<Seen> seen_;
};

struct Measured {
  double time_s = std::nan("");
  double travel_m = 0.0;
};

/// The tick from which on the command pushed one way until null came: what a frozen reading is held
/// against. Not before `begin`.
std::size_t pushed_since(std::size_t begin, const std::vector<Seen>& seen) {
  for (std::size_t i = begin; i + 1 < seen.size() && seen[i + 1].sample.state == 3; ++i) {
    const double now_V = seen[i + 1].valve_V - kNull_V;
    const double before_V = seen[i].valve_V - kNull_V;
    if (std::abs(now_V) <= 0.2 || now_V * before_V < 0.0) begin = i + 2;
  }
  return begin;
}

/// From the failure (at the earliest after the tick before the one that shows it) to null.
Measured measure(const Plan& plan, const std::vector<Seen>& seen) {
  std::size_t begin = 1;
  const auto fails = [&](std::size_t i) {
    return plan.failing ? plan.failing(seen[i - 1], seen[i]) : seen[i].t_s >= plan.at_s;
  };
  while (begin < seen.size() && !fails(begin)) ++begin;
  if (plan.guard == "frozen") begin = pushed_since(begin, seen);
  if (begin == seen.size()) return {};
  EXPECT_EQ(seen[begin - 1].sample.state, 3) << plan.row << ": not in RUN before it";
  const double from_s =
      plan.failing ? seen[begin - 1].t_s : std::max(plan.at_s, seen[begin - 1].t_s);
  Measured measured;
  for (std::size_t i = begin; i + 1 < seen.size(); ++i) {
    measured.travel_m =
        std::max(measured.travel_m, std::abs(seen[i].rod_m - seen[begin - 1].rod_m));
    if (std::abs(seen[i + 1].valve_V - kNull_V) < 0.003) {  // one step of the converter
      measured.time_s = std::max(0.0, seen[i].t_s - from_s);
      break;
    }
  }
  return measured;
}

Plan plan(const char* row) {
  Plan p;
  p.row = row;
  return p;
}

Plan guard_plan(const char* kind, const char* action) {
  Plan p;
  p.row = std::string("guard ") + kind;
  p.guard = kind;
  p.action = action;
  return p;
}

/// All failures that begin at about that time.
std::vector<Plan> plans(double at_s, const char* action) {
  std::vector<Plan> all;
  const auto add = [&](Plan p) {
    p.at_s = at_s;
    all.push_back(std::move(p));
    return &all.back();
  };
  // The loop is told or stalled between two ticks: just after the earlier one at worst.
  const double tick_s = std::ceil(at_s / kTs_s) * kTs_s;
  add(plan("stop, signal or error"))->close_s = at_s;
  all.back().at_s = tick_s;
  add(plan("position missing"))->troubles = trouble("missing", at_s);
  Plan* late = add(plan("loop late, then back"));
  late->stall_s = at_s;
  late->stall_periods = 9;
  late->at_s = tick_s;
  add(plan("bus lost"))->troubles = trouble("deaf", at_s);
  for (const char* row : {"process killed", "process stopped"}) {
    Plan* stopped = add(plan(row));
    stopped->stall_s = at_s;
    stopped->stall_periods = 100;
    stopped->at_s = tick_s;
  }
  add(plan("enable lost"))->enable_s = at_s;
  add(guard_plan("e_stop", action))->e_stop_s = at_s;
  add(guard_plan("travel", action))->failing = [](const Seen&, const Seen& now) {
    return now.rod_m > 0.33;
  };
  add(guard_plan("speed", action))->failing = [](const Seen& before, const Seen& now) {
    return std::abs(now.sample.y_m - before.sample.y_m) > 0.12 * kTs_s;
  };
  // The reading stands still while the reference goes on.
  Plan* following = add(guard_plan("following", action));
  following->troubles = trouble("frozen", at_s);
  following->failing = [](const Seen&, const Seen& now) {
    return std::abs(now.sample.reference_m - now.sample.y_m) > 0.03;
  };
  add(guard_plan("stale", action))->troubles = trouble("stale", at_s);
  Plan* frozen = add(guard_plan("frozen", action));
  frozen->troubles = trouble("frozen", at_s);
  add(guard_plan("jump", action))->troubles = trouble("jump", at_s);
  Plan* saturated = add(guard_plan("saturated", action));
  saturated->troubles = trouble("jump", at_s) + trouble("jump", at_s) + trouble("jump", at_s) +
                        trouble("jump", at_s) + trouble("jump", at_s) + trouble("jump", at_s) +
                        trouble("jump", at_s) + trouble("jump", at_s) + trouble("jump", at_s) +
                        trouble("jump", at_s) + trouble("jump", at_s);
  saturated->failing = [](const Seen&, const Seen& now) { return now.sample.saturated; };
  add(guard_plan("disagree", action))->spare_off_s = at_s;
  Plan* overrun = add(guard_plan("overrun", action));
  overrun->stall_s = at_s;
  overrun->stall_periods = 3;
  overrun->at_s = tick_s + 3 * kTs_s;  // the last period lost
  return all;
}

struct Row {
  std::string failure;
  double stated_s, stated_m, measured_s = 0.0, measured_m = 0.0;
};

void print(const char* action, const std::vector<Row>& rows) {
  std::printf("# action %s\n# %-24s %-8s %16s %16s %18s %18s\n", action, "failure", "valve",
              "stated (ms)", "measured (ms)", "stated travel (mm)", "measured (mm)");
  for (const Row& row : rows) {
    std::printf("# %-24s %-8s %16.1f %16.1f %18.2f %18.2f\n", row.failure.c_str(), "sim",
                row.stated_s * 1e3, row.measured_s * 1e3, row.stated_m * 1e3, row.measured_m * 1e3);
  }
}

void hold_against_the_table(const char* action) {
  std::vector<Row> rows;
  // Whole periods and parts of one, in and against the direction of motion.
  for (int k = 0; k < 12; ++k) {
    const double at_s = 2.0 + 0.0613 * k;
    std::vector<Plan> all = plans(at_s, action);
    rows.resize(all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      Stand stand(all[i]);
      const auto stated = stand.stated();
      const auto row = std::find_if(stated.begin(), stated.end(),
                                    [&](const NullRow& r) { return r.failure == all[i].row; });
      ASSERT_NE(row, stated.end()) << all[i].row;
      rows[i].failure = row->failure;
      rows[i].stated_s = row->time_s;
      rows[i].stated_m = row->time_s * stand.speed_mps();
      const Measured measured = measure(all[i], stand.run());
      ASSERT_FALSE(std::isnan(measured.time_s)) << row->failure << ": never at null, " << at_s;
      rows[i].measured_s = std::max(rows[i].measured_s, measured.time_s);
      rows[i].measured_m = std::max(rows[i].measured_m, measured.travel_m);
    }
  }
  print(action, rows);
  for (const Row& row : rows) {
    EXPECT_LE(row.measured_s, row.stated_s + kRounding_s) << row.failure;
    EXPECT_LE(row.measured_m, row.stated_m) << row.failure;
  }
}

TEST(NullMatrix, OnTheSimulatedRigIsNeverWorseThanStatedWhenGuardsLatch) {
  hold_against_the_table("latch");
}

TEST(NullMatrix, OnTheSimulatedRigIsNeverWorseThanStatedWhenGuardsRamp) {
  hold_against_the_table("ramp");
}

TEST(NullMatrix, SaysNeverWhereNothingButTheProcessTakesTheCommandAway) {
  NullFacts facts;
  facts.guards = control::all_guards({}, control::Action::latch);
  const auto row = [&](const char* failure) {
    for (const NullRow& r : null_rows(facts)) {
      if (r.failure == failure) return r;
    }
    return NullRow{"not there", 0.0, ""};
  };
  EXPECT_TRUE(std::isnan(row("process killed").time_s));
  EXPECT_EQ(row("process killed").note, "D/A holds; permit/watchdog needed");
  facts.has_permit = true;
  EXPECT_EQ(row("process stopped").note, "the permit's relay");
  facts.times.process_dead_s = 0.05;
  EXPECT_EQ(row("process stopped").time_s, 0.05);
  facts.times.process_stopped_s = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(row("process stopped").time_s));
  EXPECT_EQ(row("guard e_stop").failure, "not there") << "no input of that role";
}

}  // namespace
}  // namespace monitor
