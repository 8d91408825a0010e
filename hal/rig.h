// The rig that the configuration names: which backend reads the rod, which one drives the valve.
//
// TOML: `[rod] backend`, `[valve] backend, null_V, limit_V, slew_V_per_s`, and one table for each
// backend that is used, named like it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/backend.h"

namespace hal {

struct ValveConfig {
  std::string backend = "none";
  double null_V = 0.0;
  double limit_V = 10.0;
  double slew_V_per_s = std::numeric_limits<double>::infinity();
};

class Rig {
 public:
  Rig();

  /// Lists [rod], [valve] and the tables of the backends that those two name.
  void visit(config::schema::Visitor& v);
  /// Throws Error when the chosen backends do not exist or do not do what is asked of them.
  [[nodiscard]] Devices open(const Opening& opening) const;

  [[nodiscard]] const std::string& rod_backend() const noexcept { return rod_; }
  [[nodiscard]] const ValveConfig& valve() const noexcept { return valve_; }
  /// No device moves anything real.
  [[nodiscard]] bool harmless() const;
  /// Fastest rod under a held limit_V, NaN when it cannot be said.
  [[nodiscard]] double worst_speed_mps(const Opening& opening) const;

 private:
  [[nodiscard]] const Backend* find(const std::string& name) const noexcept;

  std::string rod_ = "sim";
  ValveConfig valve_;
  std::vector<std::unique_ptr<Backend>> backends_;  ///< in the order of the registry
};

/// Names of all backends, as messages list them: "sim, replay".
[[nodiscard]] std::string backend_names();

}  // namespace hal
