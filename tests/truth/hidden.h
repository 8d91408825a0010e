// Every effect of the product's library, with its parameter names, for the plants of this folder.
#pragma once

#include <limits>

namespace truth {

/// At values without influence. A plant takes those effects for which its equations have a place.
struct Hidden {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double delay_s = 0.0;
  double lag_s = 0.0;            ///< time constant of an axis' drive
  double drive_limit_V = kNone;  ///< largest command that is followed
  double null_bias_V = 0.0;
  double hysteresis_V = 0.0;  ///< half the width of the play
  double spool_rate_mps = kNone;
  double deadband_V = 0.0;   ///< half width
  double corner_V = 0.0;     ///< half the range of commands over which its edges lie
  double clearance_V = 0.0;  ///< between its lands and their bore
  double ahead_ratio = 0.0;  ///< share of the dead band that is the amplifier's
  double asymmetry_ratio = 0.0;
  double flow_limit_m3ps = kNone;
  double droop_Pa_per_m3ps = 0.0;
  double internal_m3ps_per_Pa = 0.0;
  double external_m3ps_per_Pa = 0.0;
  double air_ratio = 0.0;
  double coulomb_N = 0.0;
  double static_N = 0.0;
  double stribeck_mps = 0.01;
  double presliding_N_per_m = 1e7;   ///< s0: rigid contact is not in LuGre; this is as good as it
  double bristle_N_s_per_m = 700.0;  ///< s1, which the product does not know
  double direction_ratio = 0.0;
  double transition_mps = 0.0;  ///< above 0: a smooth contact in place of the bristle
  double damping_speed_mps = std::numeric_limits<double>::infinity();  ///< s1 fades over it
  double quadratic_N_s2_per_m2 = 0.0;
  double spring_N_per_m = 0.0;
  double rest_m = 0.305;
  double force_N = 0.0;
  double ripple_N = 0.0;
  double ripple_wavelength_m = 0.01;
  double ripple_phase_rad = 0.0;
  double ripple_second_sin_N = 0.0;
  double ripple_second_cos_N = 0.0;
  double slaves_kg = 0.0;
  double slaves_N_s_per_m = 0.0;
  double needle_N_s2_per_m2 = 0.0;
  double backlash_m = 0.0;  ///< whole width
  double eccentricity_m = 0.0;
  double eccentricity_wavelength_m = 0.02;
  double eccentricity_phase_rad = 0.0;
};

}  // namespace truth
