// Configuration of the failover between redundant rod sensors.
//
// TOML [failover]; without it the configured sensor always stays in charge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "config/schema/visitor.h"

namespace monitor::control {

/// The configured rod sensor and the spare ones.
inline constexpr std::size_t kMaxRods = 5;

/// Id of the configured sensor.
inline constexpr const char* kRodId = "rod";

/// Why a rod sensor is out; the values are those of rods_t.
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
    v.number({"tolerance_m", "allowed difference between sensors", true}, tolerance_m,
             {1e-7, 100.0});
    v.number(
        {"confirm_s", "time beyond tolerance_m from the middle of three or more before exclusion"},
        confirm_s, {0.0, 60.0});
    v.number({"return_s",
              "time with right readings before automatic readmission; a start or an "
              "acknowledgement readmits earlier"},
             return_s, {0.0, kInfinite});
  }
};

}  // namespace monitor::control
