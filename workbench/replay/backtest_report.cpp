#include "workbench/replay/backtest_report.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>

namespace workbench::replay {
namespace {

using nlohmann::ordered_json;

std::string time_text(double t_s) {
  return std::isnan(t_s) ? "the end" : fmt::format("{:.3f} s", t_s);
}

std::string words(const Occurrence& o) {
  return o.alarm +
         (o.direction > 0   ? " high"
          : o.direction < 0 ? " low"
                            : "") +
         ", " + time_text(o.from_s) + " to " + time_text(o.to_s);
}

ordered_json json_of(const Occurrence& o) {
  constexpr const char* kSeverity[] = {"OK", "MINOR", "MAJOR", "INVALID"};
  return {{"alarm", o.alarm},
          {"from_s", o.from_s},
          {"to_s", std::isnan(o.to_s) ? ordered_json(nullptr) : ordered_json(o.to_s)},
          {"severity", o.severity >= 0 && o.severity < 4 ? kSeverity[o.severity] : "?"},
          {"direction", o.direction}};
}

ordered_json json_of(const std::vector<Occurrence>& list) {
  ordered_json out = ordered_json::array();
  for (const Occurrence& o : list) out.push_back(json_of(o));
  return out;
}

struct Totals {
  std::size_t appear = 0, disappear = 0, shift = 0;
  std::int64_t same = 0;
  void add(const OccurrenceDifference& d) {
    appear += d.appears.size();
    disappear += d.disappears.size();
    shift += d.shifts.size();
    same += d.same;
  }
};

Totals totals(const BacktestReport& report) {
  Totals all;
  for (const OccurrenceDifference& d : report.differences) all.add(d);
  return all;
}

std::string words(const Totals& t) {
  return std::to_string(t.appear) + " appear, " + std::to_string(t.disappear) + " disappear, " +
         std::to_string(t.shift) + " shift, " + std::to_string(t.same) + " stay the same";
}

}  // namespace

void print_backtest(const BacktestReport& report, std::ostream& out) {
  for (std::size_t i = 0; i < report.runs.size(); ++i) {
    const BacktestRun& run = report.runs[i];
    const OccurrenceDifference& difference = report.differences[i];
    out << std::filesystem::path(run.files.front()).filename().string();
    if (run.files.size() > 1) out << " and " << run.files.size() - 1 << " more";
    out << ", " << time_text(run.from_s) << " to " << time_text(run.to_s) << '\n';
    if (!run.has_recorded_alarms && report.old_rules.empty()) {
      out << "  no alarms were recorded here: --old compares with a configuration\n";
    }
    for (const Occurrence& o : difference.appears) out << "  appears     " << words(o) << '\n';
    for (const Occurrence& o : difference.disappears) out << "  disappears  " << words(o) << '\n';
    for (const Shift& s : difference.shifts) {
      out << "  shifts      " << words(s.before) << " -> " << time_text(s.after.from_s) << " to "
          << time_text(s.after.to_s)
          << fmt::format(" ({:+.3f} s)\n", s.after.from_s - s.before.from_s);
    }
    Totals one;
    one.add(difference);
    out << "  " << words(one) << '\n';
  }
  if (report.runs.size() != 1) {
    out << "in " << report.runs.size() << " runs: " << words(totals(report)) << '\n';
  }
}

ordered_json backtest_json(const BacktestReport& report) {
  ordered_json runs = ordered_json::array();
  for (std::size_t i = 0; i < report.runs.size(); ++i) {
    const BacktestRun& run = report.runs[i];
    const OccurrenceDifference& d = report.differences[i];
    ordered_json shifts = ordered_json::array();
    for (const Shift& s : d.shifts) {
      shifts.push_back({{"before", json_of(s.before)},
                        {"after", json_of(s.after)},
                        {"shift_s", s.after.from_s - s.before.from_s}});
    }
    runs.push_back({{"files", run.files},
                    {"from_s", run.from_s},
                    {"to_s", run.to_s},
                    {"samples", run.samples},
                    {"appears", json_of(d.appears)},
                    {"disappears", json_of(d.disappears)},
                    {"shifts", std::move(shifts)},
                    {"same", d.same},
                    {"alarms", json_of(run.after)}});
  }
  const Totals all = totals(report);
  return {{"configuration", report.new_rules},
          {"compared_with", report.old_rules.empty() ? "recorded" : report.old_rules},
          {"runs", std::move(runs)},
          {"total",
           {{"appear", all.appear},
            {"disappear", all.disappear},
            {"shift", all.shift},
            {"same", all.same}}}};
}

}  // namespace workbench::replay
