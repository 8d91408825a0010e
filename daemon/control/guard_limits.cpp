#include "daemon/control/guard_limits.h"

#include <algorithm>

namespace monitor::control {
namespace {

struct Limit {
  const char* key;
  double GuardConfig::*value;
  bool more_is_looser;
};

constexpr Limit kLimits[] = {
    {"low_m", &GuardConfig::low_m, false},
    {"high_m", &GuardConfig::high_m, true},
    {"braking_mps2", &GuardConfig::braking_mps2, true},
    {"limit_m", &GuardConfig::limit_m, true},
    {"limit_mps", &GuardConfig::limit_mps, true},
    {"age_s", &GuardConfig::age_s, true},
    {"least_m", &GuardConfig::least_m, false},
    {"command_V", &GuardConfig::command_V, true},
    {"tolerance_m", &GuardConfig::tolerance_m, true},
    {"low_Pa", &GuardConfig::low_Pa, false},
    {"high_Pa", &GuardConfig::high_Pa, true},
    {"tolerance_Pa", &GuardConfig::tolerance_Pa, true},
    {"time_s", &GuardConfig::time_s, true},
};

const GuardConfig* find(const std::vector<GuardConfig>& guards, const std::string& id) {
  const auto found = std::find_if(guards.begin(), guards.end(),
                                  [&](const GuardConfig& guard) { return guard.id == id; });
  return found == guards.end() ? nullptr : &*found;
}

}  // namespace

bool is_guard_limit(std::string_view key) noexcept {
  return std::any_of(std::begin(kLimits), std::end(kLimits),
                     [&](const Limit& limit) { return key == limit.key; });
}

std::string loosened_limit(const std::vector<GuardConfig>& before,
                           const std::vector<GuardConfig>& after) {
  for (const GuardConfig& old : before) {
    const GuardConfig* next = find(after, old.id);
    if (next == nullptr) continue;
    for (const Limit& limit : kLimits) {
      const double change = next->*limit.value - old.*limit.value;
      if (limit.more_is_looser ? change > 0.0 : change < 0.0) return old.id + ": " + limit.key;
    }
  }
  return "";
}

std::vector<GuardConfig> with_limits_of(std::vector<GuardConfig> before,
                                        const std::vector<GuardConfig>& after) {
  for (GuardConfig& guard : before) {
    const GuardConfig* next = find(after, guard.id);
    if (next == nullptr) continue;
    for (const Limit& limit : kLimits) guard.*limit.value = next->*limit.value;
  }
  return before;
}

}  // namespace monitor::control
