// Numbers as an engineer reads them: in the unit of the size, rounded to what is known of them.
//
//   2.63e-5 m -> "26.3 um"      0.0612 V +- 0.0011 -> "61.2 +- 1.1 mV"
//
// On a rotary axis the same names stand for angles, torques and inertias, and are printed so:
//
//   2.63e-5 m -> "26.3 urad"    12 N -> "12 N m"    0.006 kg -> "0.006 kg m2"
#pragma once

#include <string>
#include <string_view>

namespace config::units {

enum class Motion { linear, rotary };

/// While the object lives, its thread prints quantities of an axis that moves so; afterwards again
/// as before. Each thread has its own: one that made no object prints those of a linear axis.
class PrintedAxis {
 public:
  explicit PrintedAxis(Motion motion) noexcept;
  ~PrintedAxis();
  PrintedAxis(const PrintedAxis&) = delete;
  PrintedAxis& operator=(const PrintedAxis&) = delete;

 private:
  Motion before_;
};

/// Motion of the axis whose quantities this thread prints.
[[nodiscard]] Motion motion() noexcept;

/// "m" or "rad", "mm/s" or "mrad/s": a unit of the linear axis as the axis that is printed has it.
[[nodiscard]] std::string axis_unit(std::string_view unit);

/// "rod", or "axis" where it turns.
[[nodiscard]] std::string moving_part();

/// Text about the linear axis, of the axis that is printed: "force" is "torque" and "extending"
/// "turning forwards" where it turns.
[[nodiscard]] std::string axis_words(std::string_view text);

struct Quantity {
  std::string value;
  std::string error;  ///< empty: not known
  std::string unit;   ///< empty: a bare number
};

/// `name` carries the unit as its suffix ("friction.coulomb_N"); value and error in it. The error
/// may be NaN. The unit is chosen by the larger of |value| and `reference`.
[[nodiscard]] Quantity quantity(std::string_view name, double value, double std_error,
                                double reference = 0.0);

/// "145 +- 2 N"; without the error when it is not known.
[[nodiscard]] std::string words(const Quantity& quantity);

// Numbers for tables and sentences; "-" for a missing one.

/// "0.31", "381", "1520".
[[nodiscard]] std::string three_digits(double value);

/// "26.3 um", "1.42 mm".
[[nodiscard]] std::string length_words(double length_m);

/// "0.31 mm/s".
[[nodiscard]] std::string speed_words(double speed_mps);

/// "3.1e-05", "< 1e-6": a probability.
[[nodiscard]] std::string chance_words(double p);

/// "Coulomb" of "friction.coulomb_N", "half width" of "deadband.half_width_V".
[[nodiscard]] std::string parameter_words(std::string_view name);

/// "1.12", "53", "12339": how many times.
[[nodiscard]] std::string times_words(double ratio);

/// Text for the page: "um" as the micrometre sign has it, "+-" as one sign.
[[nodiscard]] std::string typeset(std::string text);

/// "N s/m" for "damping_N_s_per_m"; "" for a number without a unit. Of the name alone: the same for
/// a rotary axis.
[[nodiscard]] std::string unit_of(std::string_view name);

}  // namespace config::units
