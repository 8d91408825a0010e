// What takes a rod sensor out of charge where the rig has several, and what brings it back.
//
// TOML [failover]; without it the sensor in charge is the configured one for good.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "config/schema/visitor.h"

namespace monitor::control {

/// The configured rod sensor and the spare ones.
inline constexpr std::size_t kMaxRods = 5;

/// The configured one's name; the others' are their ids.
inline constexpr const char* kRodId = "rod";

/// Why a rod sensor is out; the numbers are those of rods_t.
enum class RodFault : std::uint8_t { none, missing, stale, frozen, jump, outvoted };

[[nodiscard]] constexpr const char* to_string(RodFault fault) noexcept {
  constexpr const char* kNames[] = {"none", "missing", "stale", "frozen", "jump", "outvoted"};
  return kNames[static_cast<std::size_t>(fault)];
}

struct FailoverConfig {
  bool present = false;
  double tolerance_m = std::numeric_limits<double>::quiet_NaN();
  double confirm_s = 0.02;
  double return_s = std::numeric_limits<double>::infinity();

  void visit(config::schema::Visitor& v) {
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    v.number({"tolerance_m", "by which sensors may differ", true}, tolerance_m, {1e-7, 100.0});
    v.number({"confirm_s", "off the middle of three or more before it is out"}, confirm_s,
             {0.0, 60.0});
    v.number({"return_s",
              "right for so long and it is in again; until then only a start or an "
              "acknowledgement brings it back"},
             return_s, {0.0, kInfinite});
  }
};

}  // namespace monitor::control
