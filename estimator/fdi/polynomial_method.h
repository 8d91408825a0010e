// [[polynomial]]: ARMAX, output error or Box-Jenkins followed sample by sample, where [[estimator]]
// knows ARX alone: coefficients free of the noise's colour, by recursive prediction error
// (estimator/structures/recursive_prediction_error.h has the equations and their source).
//
// While the command moves too little the coefficients are kept and nothing is forgotten. Output
// error and Box-Jenkins are for rods that a spring or a leak holds: behind an integrating rod their
// prediction drifts away; `spoolwatch select` says which structure suits a record.
#pragma once

#include "estimator/fdi/detection_method_config.h"

namespace estimator::fdi {

/// Values: the coefficients, residual_rms_m (one step, over window_s).
struct PolynomialConfig final : DetectionMethodConfigOf<PolynomialConfig> {
  std::string structure = "armax2111";
  std::string method = "prediction-error";  ///< or extended-least-squares, for ARX and ARMAX
  bool constant = true;
  double offset_m = 0.0;
  double forgetting = 0.998;
  double prior_variance = 1e10;
  double window_s = 2.0;  ///< over which the checks below hold
  double stride_s = 0.1;
  double warmup_s = 0.0;
  double min_u_rms_V = 0.05;
  double max_saturated = 0.2;
  double max_missing = 0.2;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
};

}  // namespace estimator::fdi
