// [[observer]]: one observer, or a bank of them for faults of sensors, on a linear discrete model
//
//   x+ = A x + B u + E d,   y = C x
//
// Without e it is an ordinary predictor (steady Kalman filter); with e an unknown input observer,
// whose residuals no d moves (unknown_input.h: when it exists, and its limits). A bank has one
// observer for each output, made without that output (generalised observer scheme): when one
// sensor fails, only the observer that does not use that sensor still fits.
//
//   r_i = root mean square, over window_s, of the residuals y - C x of observer i, each divided by
//         its output_std
//
// Where `limit` is given, the alarm names the output i with r_i below it while all others are
// above; when all are above, the alarm reports that the model or several sensors are wrong.
// Matrices are given row by row, in the units and about the operating point of the quantities: take
// offsets out by `input_offset` and `output_offset`. Source: R. N. Clark, IEEE Transactions on
// Aerospace and Electronic Systems 14 (1978) 456; P. M. Frank, Automatica 26 (1990) 459 (banks).
#pragma once

#include "estimator/fdi/trained.h"
#include "estimator/fdi/unknown_input.h"

namespace estimator::fdi {

/// Values: r1, r2, ... one for each observer.
struct ObserverConfig final : DetectionMethodConfigOf<ObserverConfig> {
  std::vector<std::string> u, y;  ///< quantities
  std::vector<double> a, b, c, e;
  std::vector<double> input_offset, output_offset, output_std;
  double process_std = 0.0;  ///< noise of each state, per sample, in its own unit
  double window_s = 0.5;
  double stride_s = 0.1;
  bool bank = false;
  double limit = std::numeric_limits<double>::infinity();
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> inputs() const override;
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  /// Throws schema::ConfigError when the matrices do not fit together.
  [[nodiscard]] StateSpaceModel model() const;
};

}  // namespace estimator::fdi
