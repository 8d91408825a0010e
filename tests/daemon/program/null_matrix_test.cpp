// Every failure on the simulated rig, measured: how long the valve keeps a command of the law, how
// far the rod travels meanwhile; never worse than `--check` states. Prints the same table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/daemon/program/null_stand.h"

namespace monitor {
namespace {

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
  add(guard_plan("pressure", action))->troubles = wrong_pressure("supply_pressure", -5e6, at_s);
  add(guard_plan("chambers", action))->troubles = wrong_pressure("pressure_in", 2e7, at_s);
  add(guard_plan("transducer", action))->troubles =
      trouble("missing", at_s) + "pressure = \"supply_pressure\"\n";
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
  NullTableInputs inputs;
  inputs.guards = control::all_guards({}, control::Action::latch);
  const auto row = [&](const char* failure) {
    for (const NullRow& r : null_rows(inputs)) {
      if (r.failure == failure) return r;
    }
    return NullRow{"not there", 0.0, ""};
  };
  EXPECT_TRUE(std::isnan(row("process killed").time_s));
  EXPECT_EQ(row("process killed").note, "D/A holds; permit/watchdog needed");
  inputs.has_permit = true;
  EXPECT_EQ(row("process stopped").note, "the permit's relay");
  inputs.times.process_dead_s = 0.05;
  EXPECT_EQ(row("process stopped").time_s, 0.05);
  inputs.times.process_stopped_s = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(row("process stopped").time_s));
  EXPECT_EQ(row("guard e_stop").failure, "not there") << "no input of that role";
}

}  // namespace
}  // namespace monitor
