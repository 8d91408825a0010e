// Run-time interface of a simulated plant: voltage in, rod position out. The equations behind it
// are templates (hydraulic_actuator.h); this is what hal/sim and the workbench hold.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/signals/pressures.h"
#include "plant_sim/model_file.h"
#include "plant_sim/parameter.h"

namespace plant_sim {

class Plant {
 public:
  Plant() = default;
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;
  virtual ~Plant() = default;

  /// Back to the initial state of the model file, with the parameters as they are now.
  virtual void reset() noexcept = 0;

  /// Holds u_V for duration_s: whole integration steps, rounded to the nearest. NaN counts as 0 V.
  /// No allocation; states stay finite for any input.
  virtual void advance(double u_V, double duration_s) noexcept = 0;

  /// True rod position, from the retracted end stop.
  [[nodiscard]] virtual double position_m() const noexcept = 0;
  /// The position that the sensor sees, before encoder steps and noise (instruments.h).
  [[nodiscard]] virtual double reading_m() const noexcept = 0;
  [[nodiscard]] virtual double speed_mps() const noexcept = 0;
  /// Pressures at the valve's inlet and in the chambers, without transducer error, with the
  /// parameters as they are now; not numbers where the plant has none (velocity_servo,
  /// force_driven_axis). No allocation.
  [[nodiscard]] virtual config::signals::Pressures pressures() const noexcept = 0;
  [[nodiscard]] virtual double step_s() const noexcept = 0;

  /// A parameter by name: "supply_pressure_Pa", or with its effect, "friction.coulomb_N", whether
  /// the model file names that effect or not; null when unknown. It may be written between calls of
  /// advance(); a value outside its range acts as the nearest allowed one. Lives as long as *this.
  virtual double* parameter(std::string_view dotted) noexcept = 0;
  /// The parameter's declared range and meaning; null when unknown.
  [[nodiscard]] virtual const ParameterInfo* parameter_info(
      std::string_view dotted) const noexcept = 0;
  /// Every name that parameter() knows.
  [[nodiscard]] virtual std::vector<std::string> parameter_names() const = 0;

  /// The integration state by name (SI): for tests and for starting from a known state.
  [[nodiscard]] virtual std::vector<NamedValue> state() const = 0;
  /// Values in the order of state(); others than size() of them are ignored.
  virtual void set_state(std::span<const double> values) noexcept = 0;
};

/// Builds the plant that the model file names, in its initial state.
[[nodiscard]] std::unique_ptr<Plant> make_plant(const ModelFile& model);

}  // namespace plant_sim
