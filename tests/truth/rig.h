// A plant with what stands around it: command chain, disturbances, position sensor.
//
//   command: u(t - delay) + null bias -> play (valve hysteresis) -> plant
//   reading: play (backlash) -> y + a sin(2 pi y/wavelength + phase)
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "tests/truth/machine.h"
#include "tests/truth/motion.h"
#include "tests/truth/outside.h"

namespace truth {

/// A hidden plant that is stepped by whole samples.
class Rig {
 public:
  /// steps: integration steps per 5 ms; 0 takes what the plant asks for.
  explicit Rig(std::unique_ptr<Machine> machine, int steps = 0, const Outside& outside = {},
               std::size_t seed = 0, double sample_s = kSample_s);

  /// Holds the command for one sample.
  void hold(double u_V);
  /// From now on; the state stays.
  void change(std::unique_ptr<Machine> machine) { machine_ = std::move(machine); }
  /// The position sensor's reading now without noise and rounding.
  [[nodiscard]] double reading_m() const;
  /// At the valve's inlet now, without a transducer's error.
  [[nodiscard]] double inlet_Pa() const { return machine_->inlet_Pa(x, t_s_); }

  State x;
  double least_Pa;                      ///< lowest chamber pressure so far
  double greatest_ratio;                ///< highest chamber pressure so far over the supply's
  double fastest_mps = 0.0;             ///< the rod's
  std::vector<double> spool_speed_mps;  ///< the fastest within each sample

 private:
  void advance(double u_V, double span_s);

  std::unique_ptr<Machine> machine_;
  int steps_;
  Disturber disturber_;
  double sample_s_;
  double t_s_ = 0.0;
  double played_V_ = 0.0;
  double reached_V_ = 0.0;
  double played_m_;
  std::deque<double> past_V_;
};

}  // namespace truth
