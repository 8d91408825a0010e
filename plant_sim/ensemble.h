// Up to eight parameter sets of one plant in lockstep, one per SIMD lane: a fit spends nearly all
// its time in simulations that differ in one or two parameters.
//
// A lane performs the operations of the single plant (plant.h); its rules for parameters, steps and
// commands apply here. Between samples a lane's position may be shifted: the observer's correction
// towards the measurement.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "plant_sim/model_file.h"
#include "plant_sim/pressures.h"

namespace plant_sim {

class Ensemble {
 public:
  static constexpr std::size_t kLanes = 8;
  using Values = std::array<double, kLanes>;

  Ensemble() = default;
  Ensemble(const Ensemble&) = delete;
  Ensemble& operator=(const Ensemble&) = delete;
  virtual ~Ensemble();

  /// The parameter of that name ("mass_kg", "friction.coulomb_N") for set(); none when unknown.
  [[nodiscard]] virtual std::optional<std::size_t> find(std::string_view dotted) const = 0;
  /// A value outside the parameter's range acts as the nearest allowed one. lane < kLanes.
  virtual void set(std::size_t parameter, std::size_t lane, double value) noexcept = 0;
  [[nodiscard]] virtual double get(std::size_t parameter, std::size_t lane) const noexcept = 0;

  /// Every lane to the model's initial state, its rod where the sensor shows reading_m.
  virtual void start(double reading_m) noexcept = 0;
  /// Holds u_V, one voltage for each lane, for duration_s (a whole number of steps).
  virtual void advance(const Values& u_V, double duration_s) noexcept = 0;
  /// Holds a force against extension in each lane beside those of the parameters, until the next
  /// call; ignored by a plant without forces.
  virtual void disturb(const Values& force_N) noexcept = 0;
  /// Place of that force where a second mass swings behind a spring: 0 on the driven part, 1 on the
  /// second mass, kPlaceOfSensor as at first. Ignored as above.
  virtual void place_disturbance(double place) noexcept = 0;
  /// Moves the rod, and with it the sensor's reading, without physics.
  virtual void shift(const Values& by_m) noexcept = 0;

  /// The integration state of that name ("v_mps", "second_mass.offset_m") for state() and
  /// set_state(); none when neither the plant nor an effect that fits it has such a state. An
  /// effect's states stand still while its parameters are neutral.
  [[nodiscard]] virtual std::optional<std::size_t> find_state(std::string_view name) const = 0;
  [[nodiscard]] virtual Values state(std::size_t index) const noexcept = 0;
  virtual void set_state(std::size_t index, const Values& values) noexcept = 0;

  [[nodiscard]] virtual Values reading_m() const noexcept = 0;
  [[nodiscard]] virtual Values speed_mps() const noexcept = 0;
  /// As Plant::pressures(); NaN where the plant has none.
  [[nodiscard]] virtual PressuresOf<Values> pressures() const noexcept = 0;
};

/// The model's plant with its parameters in all lanes, stepped every step_s instead of the model's
/// own step. Throws config::schema::ConfigError like make_plant().
[[nodiscard]] std::unique_ptr<Ensemble> make_ensemble(const ModelFile& model, double step_s);

/// Every one gives the same bits; the wider, the faster.
enum class InstructionSet { baseline, avx2, avx512 };
/// True when this machine and this build support it.
[[nodiscard]] bool runs_here(InstructionSet set) noexcept;
/// Default of make_ensemble().
[[nodiscard]] InstructionSet fastest_here() noexcept;
/// Uses an instruction set that this machine supports.
[[nodiscard]] std::unique_ptr<Ensemble> make_ensemble(const ModelFile& model, double step_s,
                                                      InstructionSet set);

}  // namespace plant_sim
