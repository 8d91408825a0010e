// A record: a rig in its position loop, and the log of it.
//
//   u_k = Kp (r_k - y_k) + Ki T sum(r - y) - Kd (y_k - y_k-1)/T + Kr (r_k+1 - r_k)/T,
//   12 bits over +-10 V;  y_k = reading + noise in steps of the encoder
//   row k: y and pressures are sampled, then u is written and held for the loop's period T
//
// Kp = Ki = Kd = 0 is open loop: Kr alone makes a command that moves the rod along r. The sum stops
// while the command is at its limit. The log takes every nth row: its commands between two rows are
// not in it, or it has the mean of the command from one row to the next.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "tests/truth/actuator.h"
#include "tests/truth/axis.h"
#include "tests/truth/rig.h"
#include "tests/truth/rod.h"

namespace truth {

enum class Kind { actuator, linear_axis, rotary_axis, single_rod };
inline constexpr std::array kKinds{Kind::actuator, Kind::linear_axis, Kind::rotary_axis,
                                   Kind::single_rod};

/// A fault of the actuator: from at_s on one value of the plant, or of what is hidden, is another.
struct Change {
  double at_s = 0.0;
  double Plant::*plant = nullptr;
  double Hidden::*hidden = nullptr;  ///< one of the two
  double value = 0.0;
};

/// Everything that makes a record; the same values give the same record.
struct Case {
  std::size_t seed = 1;  ///< seeds motion and noise
  Kind kind = Kind::actuator;
  std::string motion = "multisine";
  double amplitude_ratio = 1.0;  ///< scales the motion about its centre
  double period_s = 0.0;         ///< the motion repeats; 0: it does not
  bool mismatched = false;       ///< told, not used: the plant below holds the differences
  double length_s = 30.0;
  double sample_s = kSample_s;  ///< the loop's
  int log_every = 1;            ///< rows of the loop per row of the log
  bool log_mean = false;        ///< logs the command's mean
  double kp_V_per_m = 100.0;
  double ki_V_per_m_s = 0.0;
  double kd_V_s_per_m = 0.0;
  double feed_V_s_per_m = 0.0;  ///< Kr
  double noise_m = 2e-6;
  double encoder_m = 5e-6;  ///< 0 for none
  double converter_V = 20.0 / 4096.0;
  double pressure_noise_Pa = -1.0;  ///< each of three transducers' noise; below 0: there are none
  Plant plant;                      ///< this, axis or rod goes by the kind
  AxisPlant axis;
  RodPlant rod;
  Hidden hidden;
  LeftOut left_out;
  Outside outside;
  std::vector<Change> changes;  ///< in any order; of the loop's record, not of replay()
};

/// A row per period of the loop, whatever the log takes of it.
struct Record {
  int log_every = 1;
  bool log_mean = false;
  int digits = 6;  ///< y's in the log
  std::vector<double> t_s, u_V, y_m;
  std::vector<double> reading_m;                 ///< y without noise and rounding
  std::vector<double> supply_Pa, in_Pa, out_Pa;  ///< as read; empty: there are no transducers
  double floor_m = 0.0;                          ///< RMS of y - reading
  double least_Pa = 0.0, greatest_ratio = 0.0, fastest_mps = 0.0;
  double quick_spool_mps = 0.0;  ///< exceeded in one sample of a hundred
};

/// The case's plant by itself.
std::unique_ptr<Machine> machine(const Case& of);
Record simulate(const Case& of, int steps = 0);
/// The readings of the case's plant under a given command, open loop, at the loop's period.
std::vector<double> replay(const Case& of, const std::vector<double>& u_V, int steps = 0);
/// t_s,u_V,y_m, and pressures where they were read; throws std::runtime_error when the file cannot
/// be written.
void write_csv(const Record& record, const std::string& file);

}  // namespace truth
