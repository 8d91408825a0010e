// The actuator with what stands around it: command chain, sensor, controller, converters.
//
//   command: u(t - delay) + null bias -> play (valve hysteresis) -> spool
//   reading: play (backlash) -> y + a sin(2 pi y/wavelength + phase)
//   loop:    u_k = Kp (r_k - y_k), 12 bits over +-10 V, at 200 Hz; y_k = reading + noise in steps
//            of the encoder; row k: y and pressures are sampled, then u is written and held
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "tests/truth/actuator.h"
#include "tests/truth/motion.h"
#include "tests/truth/outside.h"

namespace truth {

/// A hidden plant that is stepped by whole samples of 5 ms.
class Rig {
 public:
  /// steps: integration steps per sample; 0 takes 200, or 400 with friction.
  Rig(const Plant& plant, const Hidden& hidden, const LeftOut& left_out, int steps = 0,
      const Outside& outside = {}, std::size_t seed = 0);

  /// Holds the command for one sample.
  void hold(double u_V);
  /// From now on; the state stays.
  void change(const Plant& plant, const Hidden& hidden);
  /// What the position sensor would show now without noise and rounding.
  [[nodiscard]] double reading_m() const;
  /// At the valve's inlet now, without a transducer's error.
  [[nodiscard]] double inlet_Pa() const { return actuator_.inlet_Pa(x, t_s_); }

  State x;
  double least_Pa;                      ///< lowest chamber pressure so far
  double greatest_ratio;                ///< highest chamber pressure so far over the supply's
  double fastest_mps = 0.0;             ///< of the rod
  std::vector<double> spool_speed_mps;  ///< the fastest within each sample

 private:
  void advance(double u_V, double span_s);

  Actuator actuator_;
  int steps_;
  Disturber disturber_;
  double t_s_ = 0.0;
  double played_V_ = 0.0;
  double reached_V_ = 0.0;
  double played_m_;
  std::deque<double> past_V_;
};

/// A fault: from at_s on one value of the plant, or of what is hidden, is another.
struct Change {
  double at_s = 0.0;
  double Plant::*plant = nullptr;
  double Hidden::*hidden = nullptr;  ///< one of the two
  double value = 0.0;
};

/// Everything that makes a record; the same values give the same record.
struct Case {
  std::size_t seed = 1;  ///< of motion and noise
  std::string motion = "multisine";
  bool mismatched = false;  ///< told, not used: the plant below holds the differences
  double length_s = 30.0;
  double kp_V_per_m = 100.0;
  double noise_m = 2e-6;
  double encoder_m = 5e-6;  ///< 0 for none
  double converter_V = 20.0 / 4096.0;
  double pressure_noise_Pa = -1.0;  ///< of three transducers; below 0: there are none
  Plant plant;
  Hidden hidden;
  LeftOut left_out;
  Outside outside;
  std::vector<Change> changes;  ///< in any order; of the loop's record, not of replay()
};

struct Record {
  std::vector<double> t_s, u_V, y_m;
  std::vector<double> reading_m;                 ///< y without noise and rounding
  std::vector<double> supply_Pa, in_Pa, out_Pa;  ///< as read; empty: there are no transducers
  double floor_m = 0.0;                          ///< RMS of y - reading
  double least_Pa = 0.0, greatest_ratio = 0.0, fastest_mps = 0.0;
  double quick_spool_mps = 0.0;  ///< exceeded in one sample of a hundred
};

Record simulate(const Case& of, int steps = 0);
/// The readings of the case's plant under a given command, open loop.
std::vector<double> replay(const Case& of, const std::vector<double>& u_V, int steps = 0);
/// t_s,u_V,y_m, and pressures where they were read; throws std::runtime_error when the file cannot
/// be written.
void write_csv(const Record& record, const std::string& file);

}  // namespace truth
