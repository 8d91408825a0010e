// The long run and the books find what is wrong, and find nothing where all is right.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <map>
#include <sstream>

#include "tests/soak/alarm_watch.h"
#include "tests/soak/books.h"
#include "tests/soak/fault_plan.h"
#include "tests/soak/month_check.h"
#include "tests/soak/quiet.h"
#include "tests/soak/week.h"

namespace soak {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

WeekResult hours(double hours, bool record, const std::vector<std::string>& more = {}) {
  WeekOptions options;
  options.config = SPOOLWATCH_SOURCE_DIR "/config/demo.toml";
  options.hours = hours;
  options.record = record;
  options.more = more;
  std::ostringstream out;
  WeekResult result = run_week(options, out);
  EXPECT_EQ(result.samples, static_cast<std::int64_t>(hours * 3600.0 * 200.0) + 1) << out.str();
  return result;
}

QuietResult minutes(const std::vector<Fault>& faults) {
  QuietOptions options;
  options.config = SPOOLWATCH_SOURCE_DIR "/config/thesis_case3_named.toml";
  options.hours = 0.1;
  options.faults = faults;
  return run_quiet(options);
}

TEST(QuietHours, HaveNoAlarmAndHoldEverySample) {
  const QuietResult result = minutes({});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.samples, 360 * 200 + 1);
  EXPECT_GT(result.valid, 600);  // of two a second, less the lead-in and what is learnt from
  EXPECT_THAT(result.alarms, IsEmpty());
}

TEST(QuietHours, SeeAnAlarmThatComes) {
  const QuietResult result = minutes({{200.0, 0.0, 1.25, 300.0, 0.0}});
  EXPECT_THAT(result.alarms, ElementsAre(HasSubstr("physics.supply_pressure_Pa")));
}

TEST(SimulatedWeek, AnHourWithRandomFaultsIsRight) {
  const WeekResult result = hours(1.0, true);
  EXPECT_THAT(result.problems, IsEmpty());
  EXPECT_GE(result.faults, 10U);
  // Each fault raises both alarms.
  EXPECT_GE(result.comings, static_cast<std::int64_t>(2 * result.faults));
}

TEST(SimulatedWeek, FindsABandThatDoesNotSeeLowPressure) {
  const WeekResult result = hours(0.25, false, {"--set", "band.1.low=0.00005"});
  EXPECT_THAT(result.problems, Contains(HasSubstr("supply_pressure_fast has not come")));
}

TEST(SimulatedWeek, FindsFalseAlarms) {
  const WeekResult result = hours(0.25, false, {"--set", "band.0.high=0.00019"});
  EXPECT_THAT(result.problems,
              Contains(HasSubstr("supply_pressure says high, and nothing is wrong")));
}

const std::vector<Fault> kOneFault{{100.0, 0.0, 1.25, 150.0, 0.0}};

TEST(AlarmWatch, IsContentWithAnAlarmWithinItsTimes) {
  AlarmWatch watch("p", kOneFault, {2.0, 0.5});
  watch.see(101.9, true, 1);
  watch.see(152.4, false, 0);
  watch.advance(1000.0);
  EXPECT_THAT(watch.problems(), IsEmpty());
  EXPECT_NEAR(watch.slowest_on_s(), 1.9, 1e-9);
  EXPECT_NEAR(watch.slowest_off_s(), 2.4, 1e-9);
}

TEST(AlarmWatch, FindsAnAlarmThatComesOrGoesLateEarlyOrTheWrongWayRound) {
  const auto problems = [](double on_s, double off_s, int direction) {
    AlarmWatch watch("p", kOneFault, {2.0, 0.5});
    watch.see(on_s, true, direction);
    watch.see(off_s, false, 0);
    watch.advance(1000.0);
    return watch.problems();
  };
  EXPECT_THAT(problems(102.1, 151.0, 1), ElementsAre("102.005 s: p has not come"));
  EXPECT_THAT(problems(99.0, 151.0, 1), Contains(HasSubstr("nothing is wrong")));
  EXPECT_THAT(problems(101.0, 149.0, 1), ElementsAre("149.000 s: p went, and the fault lasts"));
  EXPECT_THAT(problems(101.0, 152.6, 1), ElementsAre("152.505 s: p has not gone"));
  EXPECT_THAT(problems(101.0, 151.0, -1), ElementsAre(HasSubstr("the pressure is high")));
}

TEST(AlarmWatch, GivesARampTheTimeInWhichThePressureCrossesTheEdges) {
  // From 1 to 0.75 in 10 s: off by 8 % after 3.2 s, by 20 % after 8 s.
  const auto problems = [](double on_s) {
    AlarmWatch watch("p", {{100.0, 10.0, 0.75, 150.0, 0.0}}, {2.0, 0.0});
    watch.see(on_s, true, -1);
    watch.advance(140.0);
    return watch.problems();
  };
  EXPECT_THAT(problems(103.1), Contains(HasSubstr("nothing is wrong")));
  EXPECT_THAT(problems(103.3), IsEmpty());
  EXPECT_THAT(problems(109.9), IsEmpty());
  EXPECT_THAT(problems(110.1), ElementsAre(HasSubstr("has not come")));
}

TEST(FaultPlan, DoesNotOverlapAndDependsOnTheSeedAlone) {
  const std::vector<Fault> faults = random_faults(7, 7.0 * 86400.0);
  ASSERT_GT(faults.size(), 2000U);
  for (std::size_t i = 1; i < faults.size(); ++i) {
    EXPECT_GT(faults[i].at_s, faults[i - 1].back_s + faults[i - 1].back_ramp_s + 60.0);
  }
  EXPECT_EQ(as_toml(faults), as_toml(random_faults(7, 7.0 * 86400.0)));
  EXPECT_NE(as_toml(faults), as_toml(random_faults(8, 7.0 * 86400.0)));
}

/// A second of a loop that lost periods 50 to 52 at once, and was stopped after period 199.
struct Life {
  std::vector<spoolwatch::sample_t> samples;
  spoolwatch::alarm_t alarm{};
  spoolwatch::health_t health{};
  ClosingReport closing{197, 1, 3, 0};

  Life() {
    for (std::int64_t tick = 0; tick < 200; ++tick) {
      if (tick >= 50 && tick <= 52) continue;
      spoolwatch::sample_t s{};
      s.seq = static_cast<std::int64_t>(samples.size());
      s.tick = tick;
      s.gap = tick == 53 ? 3 : 0;
      samples.push_back(s);
    }
    alarm.source = "loop";
    alarm.name = "lost_periods";
    alarm.active = 1;
    health.ticks = 197;
    health.overruns = 1;
    health.skipped_periods = 3;
  }
  [[nodiscard]] bool adds_up(bool complete = true) const {
    Books books;
    for (const auto& s : samples) books.sample(s);
    books.alarm(alarm);
    books.health(health);
    std::ostringstream out;
    return print(books.balance(closing, complete), out);
  }
};

TEST(Books, AddUpWhereEachLostCycleIsCounted) { EXPECT_TRUE(Life().adds_up()); }

TEST(Books, DoNotAddUpWhenAnythingIsLostUncounted) {
  const std::pair<const char*, std::function<void(Life&)>> mutations[] = {
      {"a sample is not in the log", [](Life& l) { l.samples.erase(l.samples.begin() + 70); }},
      {"the last one is not", [](Life& l) { l.samples.pop_back(); }},
      {"a period was skipped in silence",
       [](Life& l) {
         for (auto& s : l.samples) s.tick += s.tick >= 100 ? 1 : 0;
       }},
      {"a gap is not stated", [](Life& l) { l.samples[50].gap = 0; }},
      {"an overrun is not counted", [](Life& l) { l.health.overruns = l.closing.overruns = 0; }},
      {"the last health tells less", [](Life& l) { l.health.skipped_periods = 2; }},
      {"no alarm tells of the lost periods", [](Life& l) { l.alarm.active = 0; }},
      {"a drop is counted that was none", [](Life& l) { l.health.dropped_records = 1; }},
      {"a tick comes twice", [](Life& l) { l.samples[10].tick = 9; }}};
  for (const auto& [what, mutate] : mutations) {
    Life life;
    mutate(life);
    EXPECT_FALSE(life.adds_up()) << what;
  }
}

TEST(Books, TellARecordThatWasDroppedAndCountedFromACompleteLog) {
  Life life;
  life.samples.erase(life.samples.begin() + 70);
  life.health.dropped_records = 1;
  EXPECT_FALSE(life.adds_up(false)) << "without its alarm";
  Books books;
  for (const auto& s : life.samples) books.sample(s);
  books.alarm(life.alarm);
  life.alarm.seq = 1;
  life.alarm.source = "recorder";
  life.alarm.name = "dropping";
  books.alarm(life.alarm);
  books.health(life.health);
  std::ostringstream out;
  EXPECT_TRUE(print(books.balance(life.closing, false), out)) << out.str();
  EXPECT_FALSE(print(books.balance(life.closing, true), out)) << "nothing may be missing";
}

/// A hundred seconds of a plan with one late wake-up, a missing reading and a full disk, as the
/// daemon sends them; `mutate` sees each message first and may drop it.
struct Month {
  static constexpr std::int64_t kPeriod_ns = 5'000'000;
  std::map<std::string, std::int64_t> report{{"SPOOLWATCH_SAMPLE", 19'987},
                                             {"SPOOLWATCH_ALARM", 3},
                                             {"SPOOLWATCH_HEALTH", 1},
                                             {"unlogged", 10}};
  std::function<bool(spoolwatch::sample_t&)> sample = [](auto&) { return true; };
  std::function<bool(spoolwatch::alarm_t&)> alarm = [](auto& a) { return a.name != "jump"; };
  std::function<void(spoolwatch::health_t&)> health = [](auto&) {};

  [[nodiscard]] std::vector<std::string> problems() const {
    MonthPlan plan(1, 1.0);
    plan.late = {{1'000'000'000, 14'000'000}};
    plan.steps = {{2'000'000'000, -5'000'000}};
    plan.devices = {{"missing", "missing", 10.0, 12.0}};
    plan.disk = {{DiskTrouble::full, 20'000'000'000, 30'000'000'000}};
    MonthCheck check(plan, 100.0, kPeriod_ns);
    const auto take = [&](const char* channel, const auto& message) {
      std::vector<char> bytes(static_cast<std::size_t>(message.getEncodedSize()));
      message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
      check.take(channel, bytes.data(), static_cast<int>(bytes.size()));
    };
    std::int64_t seq = 0;
    std::int64_t alarms = 0;
    for (std::int64_t tick = 0; tick <= 20'000; ++tick) {
      if (tick >= 200 && tick < 203) continue;  // due at 1 s, awake 14 ms later
      spoolwatch::sample_t s{};
      s.seq = seq++;
      s.tick = tick;
      s.gap = tick == 203 ? 3 : 0;
      s.t_read_ns = s.mono_ns = tick * kPeriod_ns;
      s.utc_us = 1'700'000'000'000'000 + s.mono_ns / 1000 - (tick >= 400 ? 5'000'000 : 0);
      s.quality = tick >= 2000 && tick < 2400 ? 3 : 0;
      if (sample(s)) take("SPOOLWATCH_SAMPLE", s);
      const std::pair<std::int64_t, const char*> comings[] = {
          {210, "lost_periods"}, {2010, "missing"}, {4200, "disk_full"}, {19'000, "jump"}};
      for (const auto& [at, name] : comings) {
        if (at != tick) continue;
        spoolwatch::alarm_t a{};
        a.seq = alarms;
        a.mono_ns = s.mono_ns;
        a.source = at == 4200 ? "recorder" : "loop";
        a.name = name;
        a.active = 1;
        if (!alarm(a)) continue;
        take("SPOOLWATCH_ALARM", a);
        ++alarms;
      }
    }
    spoolwatch::health_t h{};
    h.ticks = seq;
    h.skipped_periods = 3;
    h.overruns = 1;
    h.lost_records = 11;
    health(h);
    take("SPOOLWATCH_HEALTH", h);
    check.finish(report);
    return check.problems();
  }
};

TEST(MonthCheck, FindsEachThingThatIsNotAccountedFor) {
  Month good;
  good.report["unlogged"] = 11;
  EXPECT_THAT(good.problems(), IsEmpty());
  const auto with = [&](auto mutate) {
    Month month = good;
    mutate(month);
    return month.problems();
  };
  EXPECT_THAT(with([](Month& m) { m.report["unlogged"] = 10; }),
              Contains(HasSubstr("daemon's last line: 11 and 10")));
  EXPECT_THAT(with([](Month& m) { m.health = [](auto& h) { h.lost_records = 10; }; }),
              Contains(HasSubstr("lost records of health: 11 and 10")));
  EXPECT_THAT(with([](Month& m) { m.report["SPOOLWATCH_SAMPLE"] = 19'980; }),
              Contains(HasSubstr("not in the log")));
  EXPECT_THAT(with([](Month& m) { m.report["partial"] = 1; }),
              Contains(HasSubstr("end within a message")));
  EXPECT_THAT(with([](Month& m) { m.sample = [](auto& s) { return s.tick != 7000; }; }),
              Contains(HasSubstr("a sequence number is missing")));
  const auto sample = [&](std::int64_t tick, auto change) {
    return with([&](Month& m) {
      m.sample = [=](auto& s) {
        if (s.tick == tick) change(s);
        return true;
      };
    });
  };
  EXPECT_THAT(sample(203, [](auto& s) { s.gap = 0; }), Contains(HasSubstr("another gap")));
  EXPECT_THAT(sample(500, [](auto& s) { s.t_read_ns += 10; }), Contains(HasSubstr("grid")));
  EXPECT_THAT(sample(500, [](auto& s) { s.utc_us += 1; }), Contains(HasSubstr("wall clock")));
  EXPECT_THAT(sample(2100, [](auto& s) { s.quality = 0; }), Contains(HasSubstr("quality")));
  EXPECT_THAT(sample(2500, [](auto& s) { s.quality = 3; }), Contains(HasSubstr("quality")));
  for (const char* name : {"missing", "disk_full"}) {
    EXPECT_THAT(with([&](Month& m) {
                  m.alarm = [name](auto& a) { return a.name != name && a.name != "jump"; };
                  m.report["SPOOLWATCH_ALARM"] = 2;
                }),
                Contains(HasSubstr("no alarm")))
        << name;
  }
  EXPECT_THAT(with([](Month& m) { m.alarm = [](auto&) { return true; }; }),
              Contains(HasSubstr("loop.jump without a fault")));
  EXPECT_THAT(with([](Month& m) { m.health = [](auto& h) { h.overruns = 0; }; }),
              Contains(HasSubstr("number of overruns")));
}

}  // namespace
}  // namespace soak
