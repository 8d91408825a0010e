#include "config/messages/plausible.h"

#include <cmath>
#include <cstdint>
#include <initializer_list>

#include "spoolwatch/sample_t.hpp"

namespace config::messages {
namespace {

constexpr double kLeastSampleTime_s = 1e-5;
constexpr double kMostSampleTime_s = 2.0;
constexpr std::int64_t kMostTicks = 1'000'000'000'000'000;
constexpr double kMost = 1e9;

}  // namespace

bool plausible(const spoolwatch::sample_t& s) noexcept {
  if (!(s.sample_time_s >= kLeastSampleTime_s && s.sample_time_s <= kMostSampleTime_s))
    return false;
  if (s.tick < 0 || s.tick > kMostTicks) return false;
  for (const double value : {s.y_m, s.u_applied_V, s.u_requested_V, s.reference_m}) {
    if (!std::isnan(value) && !(std::abs(value) <= kMost)) return false;
  }
  return true;
}

}  // namespace config::messages
