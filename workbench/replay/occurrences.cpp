#include "workbench/replay/occurrences.h"

#include <algorithm>
#include <cmath>

namespace workbench::replay {
namespace {

constexpr int kMinor = 1;  // severities of alarm_t
constexpr int kMajor = 2;

double end_of(const Occurrence& o) noexcept {
  return std::isnan(o.to_s) ? std::numeric_limits<double>::infinity() : o.to_s;
}

bool belong_together(const Occurrence& a, const Occurrence& b, double tolerance_s) noexcept {
  const bool overlap = a.from_s <= end_of(b) && b.from_s <= end_of(a);
  return a.alarm == b.alarm && (overlap || std::abs(a.from_s - b.from_s) <= tolerance_s);
}

bool equal_times(double a_s, double b_s, double sample_s) noexcept {
  if (std::isnan(a_s) || std::isnan(b_s)) return std::isnan(a_s) && std::isnan(b_s);
  return std::abs(a_s - b_s) < sample_s;
}

bool same(const Occurrence& a, const Occurrence& b, double sample_s) noexcept {
  return equal_times(a.from_s, b.from_s, sample_s) && equal_times(a.to_s, b.to_s, sample_s) &&
         a.direction == b.direction && a.severity == b.severity;
}

}  // namespace

void OccurrenceList::tell(const std::string& alarm, double t_s, bool active, int severity,
                          int direction) {
  const auto open = std::find_if(all_.rbegin(), all_.rend(), [&](const Occurrence& o) {
    return o.alarm == alarm && std::isnan(o.to_s);
  });
  const bool passed = severity == kMinor || severity == kMajor;
  if (open != all_.rend()) {
    if (!active) open->to_s = t_s;
    if (active && passed && std::isnan(open->limit_s)) open->limit_s = t_s;
  } else if (active) {
    Occurrence occurrence;
    occurrence.alarm = alarm;
    occurrence.from_s = t_s;
    occurrence.severity = severity;
    occurrence.direction = direction;
    if (passed) occurrence.limit_s = t_s;
    all_.push_back(occurrence);
  }
}

std::vector<Occurrence> passed_limits(const std::vector<Occurrence>& all) {
  std::vector<Occurrence> passed;
  for (const Occurrence& each : all) {
    if (std::isnan(each.limit_s)) continue;
    passed.push_back(each);
    passed.back().from_s = each.limit_s;
  }
  return passed;
}

OccurrenceDifference compare(const std::vector<Occurrence>& before,
                             const std::vector<Occurrence>& after, double tolerance_s,
                             double sample_s) {
  OccurrenceDifference difference;
  std::vector<bool> taken(after.size(), false);
  for (const Occurrence& old : before) {
    std::size_t best = after.size();
    for (std::size_t i = 0; i < after.size(); ++i) {
      if (taken[i] || !belong_together(old, after[i], tolerance_s)) continue;
      const bool nearer = best == after.size() || std::abs(after[i].from_s - old.from_s) <
                                                      std::abs(after[best].from_s - old.from_s);
      if (nearer) best = i;
    }
    if (best == after.size()) {
      difference.disappears.push_back(old);
      continue;
    }
    taken[best] = true;
    if (same(old, after[best], sample_s)) {
      ++difference.same;
    } else {
      difference.shifts.push_back({old, after[best]});
    }
  }
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!taken[i]) difference.appears.push_back(after[i]);
  }
  return difference;
}

}  // namespace workbench::replay
