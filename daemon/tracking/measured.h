// A record as a model is held against it: command and position on an even grid, in segments between
// which samples are missing.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace monitor::tracking {

/// Of a sample while its segment settles. A record's very first state is the model file's: pure
/// simulation begins there; a state behind a gap nobody knows.
enum Led : char { kNotLed, kLedWhereObserved, kLed };

struct Measured {
  std::string name;
  double sample_time_s = 0.0;
  std::vector<double> t_s;
  std::vector<double> u_V;
  std::vector<double> y_m;
  std::vector<std::size_t> starts;  ///< first sample of each segment, ascending, the first is 0
  std::vector<char> settled;        ///< 0 while a segment's unknown initial state dies away
  std::vector<char> led;            ///< where that state is a motion: the model is led, see Led
  std::vector<std::string> notes;   ///< restrictions that a reader of results should know

  [[nodiscard]] std::size_t size() const noexcept { return t_s.size(); }
  /// By which share of its error the model's position is set right at sample k.
  [[nodiscard]] double share(std::size_t k, double observer_per_s) const noexcept;
};

/// How long after a segment's start the error does not count.
inline constexpr double kSettling_s = 0.5;
/// A segment that begins in the midst of a motion begins with a speed and pressures that the model
/// does not know. While it settles, the model's position is led to the measured one at this rate:
/// what the unknown state shifted is gone then, down to a hundred-thousandth.
inline constexpr double kLeading_per_s = 20.0;

}  // namespace monitor::tracking
