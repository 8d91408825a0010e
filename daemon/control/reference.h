// Reference signals: the desired rod position as a function of time.
//
//   sine       r = centre + amplitude sin(2 pi f t)
//   triangle   constant speed between centre +- amplitude at frequency f, starting upwards
//   multisine  sines of the listed frequencies with Schroeder's phases; peak = amplitude
//   steps      random levels within +-amplitude, each held for hold_s, joined over rise_s by a
//              quintic with zero speed and acceleration at both ends
//   chirp      frequency rising linearly from f to f_end over sweep_s, then again; phase continuous
//   prbs       +-amplitude by a maximum-length shift register, one bit per hold_s
//   file       rows of t_s,reference_m, linear interpolation, held before and after
//
// t in s since the start of the motion, r in m. Schroeder, IEEE Trans. Inf. Theory 16 (1970) 85.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/schema/visitor.h"

namespace monitor::control {

struct ReferenceConfig {
  std::string kind = "sine";
  double centre_m = 0.305;
  double amplitude_m = 0.0254;
  double frequency_Hz = 0.5;
  std::vector<double> frequencies_Hz = {0.1, 0.3, 0.7, 1.1, 1.9};
  double hold_s = 1.0;
  double rise_s = 0.2;
  double frequency_end_Hz = 5.0;
  double sweep_s = 20.0;
  std::int64_t register_bits = 9;
  std::int64_t seed = 1;
  std::string file;

  /// Visits only the keys of the chosen kind.
  void visit(config::schema::Visitor& v);
};

class Reference {
 public:
  virtual ~Reference() = default;
  /// Position in m at t_s >= 0. Stateless and real-time safe.
  [[nodiscard]] virtual double at(double t_s) const noexcept = 0;
};

/// Relative file names refer to `folder`. Throws ConfigError for a bad file or bad frequencies.
[[nodiscard]] std::unique_ptr<Reference> make_reference(const ReferenceConfig& config,
                                                        const std::filesystem::path& folder = {});

}  // namespace monitor::control
