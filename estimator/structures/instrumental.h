// Is the least-squares ARX biased, by noise of the position in its regressors or by the loop?
// Instrumental variables beside least squares, and the Durbin-Wu-Hausman test between them.
//
//   y = psi' theta + e,   z: instruments, correlated with psi but not with e
//   two-stage:  psi^ = projection of psi on z,   theta_IV = argmin |y - psi^' theta|
//   DWH:        y = psi' theta + (psi - psi^)' gamma + e;  H0 (least squares is right): gamma = 0
//   strength:   smallest canonical correlation rho of psi and z, constant removed;
//               F = rho^2 / (1 - rho^2) (rows - instruments) / instruments, weak below 10
//
// Instruments: the reference's past where the record has it, r(t-1)..: the loop's noise cannot
// reach it. Else the (u, y) before t - n: white noise of the position makes e a moving average of
// n terms, which those do not know (an e with a longer memory would spoil them).
// Standard errors of theta_IV: Newey-West, since e is coloured where it matters.
// Sources: T. Soderstrom, P. Stoica, System Identification, chapter 8; L. Ljung, System
// Identification, 7.6; J. A. Hausman, Econometrica 46 (1978) 1251; J. H. Stock, M. Yogo, in
// Identification and Inference for Econometric Models, 2005; W. K. Newey, K. D. West, Econometrica
// 55 (1987) 703.
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/structure.h"
#include "estimator/structures/stretch.h"

namespace estimator::structures {

enum class InstrumentChoice : std::uint8_t { reference, delayed };
enum class BiasVerdict : std::uint8_t {
  no_bias_seen,
  biased,
  undetermined,  ///< the instruments are too weak
};
/// "no bias seen", "biased", "cannot tell".
[[nodiscard]] const char* to_string(BiasVerdict verdict) noexcept;
[[nodiscard]] const char* to_string(InstrumentChoice instruments) noexcept;

struct BiasTest {
  std::vector<double> least_squares;  ///< in the order of Structure::names()
  std::vector<double> least_squares_error;
  std::vector<double> instrumental;
  std::vector<double> instrumental_error;
  InstrumentChoice instruments = InstrumentChoice::delayed;
  int instrument_count = 0;
  double f_statistic = 0.0;
  double statistic = 0.0;  ///< chi-square with `dof` under H0
  int dof = 0;
  double p = 1.0;
  int rows = 0;
  BiasVerdict verdict = BiasVerdict::undetermined;
};

inline constexpr double kWeakInstruments = 10.0;
inline constexpr double kBiasLevel = 0.01;  ///< p below it: biased

/// `reference_m`: one span per stretch, as long, or empty: delayed samples are the instruments.
/// Where the reference turns out weak (a sine spans two directions only), delayed samples are tried
/// and kept when they are stronger.
[[nodiscard]] BiasTest test_bias(const Structure& structure, const Stretches& data,
                                 const std::vector<std::span<const double>>& reference_m = {});

}  // namespace estimator::structures
