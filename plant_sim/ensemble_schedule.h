// The changes of a model file ([[change]], schedule.h) in an ensemble: parameters that step, ramp
// or settle exponentially while a record is simulated, each lane with sizes and times of its own.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plant_sim/ensemble.h"
#include "plant_sim/model_file.h"

namespace plant_sim {

class EnsembleSchedule {
 public:
  /// Throws config::schema::ConfigError for a change of an unknown parameter.
  EnsembleSchedule(const ModelFile& model, const Ensemble& ensemble);

  [[nodiscard]] bool empty() const noexcept { return changes_.empty(); }
  /// The number "change.mass_kg.at_s" of the change of mass_kg; none when unknown.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view dotted) const;
  void set(std::size_t number, std::size_t lane, double value) noexcept;

  /// Takes the ensemble's parameters as those before the changes.
  void begin(const Ensemble& ensemble) noexcept;
  /// Sets the parameters to their means over [t_s, t_s + duration_s]: smooth in the time of a step.
  void apply(Ensemble& ensemble, double t_s, double duration_s) const noexcept;
  /// Gives the ensemble its parameters before the changes again.
  void end(Ensemble& ensemble) const noexcept;

 private:
  /// Numbers of a change that a fit may free, in this order.
  enum Number : std::size_t { kValue, kAt, kRamp, kTimeConstant, kNumbers };
  struct Entry {
    std::string parameter;
    std::size_t index = 0;  ///< position of the parameter in the ensemble
    double factor = 0.0;    ///< NaN where the value is given
    std::array<Ensemble::Values, kNumbers> numbers{};
    Ensemble::Values before{};
  };
  /// Share of the change at a time, 0 to 1.
  static double progress(const Entry& entry, std::size_t lane, double t_s,
                         double duration_s) noexcept;

  std::vector<Entry> changes_;
};

}  // namespace plant_sim
