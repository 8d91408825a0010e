#include "daemon/control/guard_config.h"

#include <algorithm>

#include "config/schema/error.h"

namespace monitor::control {
namespace {

struct GuardKindInfo {
  GuardKind kind;
  const char* name;
  const char* reason;
  const char* guidance;
};

/// In the order of GuardKind.
constexpr GuardKindInfo kKinds[] = {
    {GuardKind::e_stop, "e_stop", "the emergency stop is not released",
     "Find out why it was pressed; release it, reset, arm."},
    {GuardKind::missing, "missing", "position missing", "Check the rod sensor and its bus."},
    {GuardKind::bus_lost, "bus_lost", "valve not written", "Check the valve drive and its bus."},
    {GuardKind::overrun, "overrun", "too many lost periods",
     "Check the machine's load and the real-time privileges."},
    {GuardKind::travel, "travel", "the rod is beyond a travel limit",
     "Start again to return within the limits; check reference and limits."},
    {GuardKind::following, "following", "the rod does not follow the reference",
     "Check supply pressure, valve and load."},
    {GuardKind::speed, "speed", "the rod moves too fast", "Check valve, reference and load."},
    {GuardKind::stale, "stale", "the position is too old", "Check the rod sensor and its bus."},
    {GuardKind::frozen, "frozen", "the reading is frozen under a command that moves the rod",
     "Check the rod sensor, the supply and the valve's cable."},
    {GuardKind::jump, "jump", "the position jumped", "Check the rod sensor and its cable."},
    {GuardKind::saturated, "saturated", "the command has been at its limit for too long",
     "Check supply pressure, load and reference."},
    {GuardKind::disagree, "disagree", "the rod sensors disagree",
     "Find out which rod sensor is wrong before moving."},
    {GuardKind::pressure, "pressure", "a pressure is outside its limits",
     "Check pump, relief valve, accumulator and load."},
    {GuardKind::chambers, "chambers", "the pressures contradict each other",
     "Check the pressure transducers and their scales."},
    {GuardKind::transducer, "transducer", "a pressure cannot be read",
     "Check the pressure transducer and its cable."},
};

const GuardKindInfo& kind_of(GuardKind kind) noexcept {
  return kKinds[static_cast<std::size_t>(kind)];
}

/// A hold needs a valid position, a ramp a working valve.
std::vector<std::string_view> actions_of(GuardKind kind) {
  switch (kind) {
    case GuardKind::e_stop:
      return {"ramp", "latch"};
    case GuardKind::missing:
    case GuardKind::bus_lost:
      return {"indicate", "latch"};
    case GuardKind::stale:
    case GuardKind::frozen:
    case GuardKind::jump:
    case GuardKind::disagree:
    case GuardKind::chambers:
    case GuardKind::transducer:
      return {"indicate", "ramp", "latch"};
    default:
      return {"indicate", "hold", "ramp", "latch"};
  }
}

bool built_in(GuardKind kind) noexcept { return static_cast<std::size_t>(kind) < kBuiltIn; }

}  // namespace

const char* to_string(GuardKind kind) noexcept { return kind_of(kind).name; }
const char* reason_of(GuardKind kind) noexcept { return kind_of(kind).reason; }
const char* guidance_of(GuardKind kind) noexcept { return kind_of(kind).guidance; }

GuardKind GuardConfig::which() const noexcept {
  const auto* found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                   [this](const GuardKindInfo& k) { return kind == k.name; });
  return found == std::end(kKinds) ? GuardKind::travel : found->kind;
}

void GuardConfig::visit(config::schema::Visitor& v) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  std::vector<std::string_view> names;
  for (const GuardKindInfo& k : kKinds) names.emplace_back(k.name);
  v.text({"id", "name in alarms; default: the kind"}, id);
  v.choice({"kind", "kind of guard", true}, kind, names);
  if (id.empty()) id = kind;
  const GuardKind w = which();
  v.choice({"action", "action when the limits are exceeded"}, action, actions_of(w));
  if (!built_in(w) && w != GuardKind::jump) {
    const double least_s = w == GuardKind::frozen || w == GuardKind::saturated ? 1e-3 : 0.0;
    v.number({"time_s", "minimum duration", least_s > 0.0}, time_s, {least_s, 1e4});
  }
  if (w == GuardKind::travel) {
    v.number({"low_m", "lowest position"}, low_m, {-kInfinite, 100.0});
    v.number({"high_m", "highest position"}, high_m, {low_m, kInfinite});
    v.number({"braking_mps2", "guaranteed deceleration, used to predict the stopping position"},
             braking_mps2, {1e-3, kInfinite});
  }
  if (w == GuardKind::following || w == GuardKind::jump) {
    v.number({"limit_m", "largest distance", true}, limit_m, {1e-7, 100.0});
  }
  if (w == GuardKind::speed)
    v.number({"limit_mps", "highest speed", true}, limit_mps, {1e-6, 100.0});
  if (w == GuardKind::stale) v.number({"age_s", "oldest reading", true}, age_s, {1e-4, 100.0});
  if (w == GuardKind::frozen) {
    v.number({"least_m", "smallest displacement that counts as motion", true}, least_m,
             {1e-7, 100.0});
    v.number({"command_V", "deviation from null that must move the rod", true}, command_V,
             {1e-3, 100.0});
  }
  if (w == GuardKind::disagree) {
    v.number({"tolerance_m", "largest difference between two sensors", true}, tolerance_m,
             {1e-7, 100.0});
  }
  if (w == GuardKind::pressure || w == GuardKind::transducer) {
    v.choice({"channel", "role of the input that measures it", true}, channel,
             {"supply_pressure", "pressure_in", "pressure_out"});
  }
  if (w == GuardKind::pressure) {
    v.number({"low_Pa", "lowest pressure"}, low_Pa, {-kInfinite, 1e9});
    v.number({"high_Pa", "highest pressure"}, high_Pa, {low_Pa, kInfinite});
  }
  if (w == GuardKind::chambers) {
    v.number({"tolerance_Pa", "largest excess of a chamber pressure", true}, tolerance_Pa,
             {1.0, 1e9});
  }
  v.text({"guidance", "advice to the operator"}, guidance);
}

void SafetyConfig::visit(config::schema::Visitor& v) {
  v.table({"safety", "start and stop of motion"}, [this](config::schema::Visitor& t) {
    t.number({"ramp_s", "duration of a guard's ramp from the last command to null"}, ramp_s,
             {0.0, 10.0});
    t.number({"blend_s", "duration of blending from the rod's position to the reference signal"},
             blend_s, {0.0, 600.0});
    t.number({"blend_mps", "speed limit of the reference until it meets the signal"}, blend_mps,
             {1e-5, 10.0});
  });
  v.optional_table({"failover", "failover between rod sensors"}, failover.present,
                   [this](config::schema::Visitor& t) { failover.visit(t); });
  config::schema::visit_list(v, {"guard", "monitored condition and action"}, guards);
}

std::vector<GuardConfig> all_guards(const SafetyConfig& config, Action overrun_action) {
  std::vector<GuardConfig> all(kBuiltIn);
  for (std::size_t i = 0; i < kBuiltIn; ++i) all[i].id = all[i].kind = kKinds[i].name;
  all[static_cast<std::size_t>(GuardKind::overrun)].action = to_string(overrun_action);
  std::vector<bool> named(kBuiltIn, false);
  for (std::size_t i = 0; i < config.guards.size(); ++i) {
    const GuardConfig& guard = config.guards[i];
    const std::string place = "[[guard]] " + std::to_string(i + 1);
    const auto kind = static_cast<std::size_t>(guard.which());
    if (kind >= kBuiltIn) {
      all.push_back(guard);
    } else if (named[kind]) {
      throw config::schema::bad_config(place + " kind", "\"" + guard.kind + "\" is listed twice",
                                       "one guard of that kind");
    } else {
      all[kind] = guard;
      named[kind] = true;
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (all[i].id == all[k].id) {
        throw config::schema::bad_config("[[guard]] id", "\"" + all[i].id + "\" is listed twice",
                                         "unique ids");
      }
    }
  }
  if (all.size() > kMaxGuards) {
    throw config::schema::bad_config("[[guard]]", std::to_string(config.guards.size()) + " of them",
                                     "at most " + std::to_string(kMaxGuards - kBuiltIn));
  }
  return all;
}

}  // namespace monitor::control
