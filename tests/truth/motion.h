// References that the position loop follows, sampled at the loop's rate, about mid-stroke. Shapes
// and amplitudes are those of common excitation on such a stand.
//
//   multisine    ten sines at 0.1 x 1.45^i Hz, amplitude 12.7 mm/(1 + f/Hz), random phases
//   fast_steps   random levels within +-45 mm, held 0.35 s, through two lags of 0.11 s
//   slow_steps   random levels within +-50 mm, held 1.5 s, through two lags of 0.04 s
//   sine         25.4 mm at 0.5 Hz (the thesis's)
//   triangle     20 to 35 mm at 0.2 to 0.4 Hz
//   chirp        0.1 to 2.5 Hz, logarithmic, amplitude 30 mm/(1 + f/Hz)
#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

namespace truth {

inline constexpr double kSample_s = 0.005;  ///< the loop's, where a case says nothing else
inline constexpr double kCentre_m = 0.305;

/// Numbers that are the same with every standard library.
class Random {
 public:
  explicit Random(std::size_t seed) : engine_(seed) {}
  double uniform(double low, double high);
  double normal();
  /// Log-uniform between typical/factor and typical*factor.
  double around(double typical, double factor = 2.0);
  std::size_t below(std::size_t count);
  double sign() { return uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0; }

 private:
  std::mt19937_64 engine_;
};

const std::vector<std::string>& motions();
/// The reference at t = 0, sample_s, ...; throws std::invalid_argument for an unknown motion.
std::vector<double> reference_m(const std::string& motion, std::size_t samples, Random& random,
                                double sample_s = kSample_s);
/// Makes one period into `samples` samples of a motion that repeats; what its two ends differ by is
/// spread over the period.
void repeat(std::vector<double>& period_m, std::size_t samples);

}  // namespace truth
