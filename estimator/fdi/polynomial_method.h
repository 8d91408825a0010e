// [[polynomial]]: recursive ARMAX, output-error or Box-Jenkins estimation, where [[estimator]] has
// ARX alone: coefficients without bias from coloured noise, by recursive prediction error
// (estimator/structures/recursive_prediction_error.h has the equations and their source).
//
// While the command moves too little, the coefficients are kept and nothing is forgotten. Output
// error and Box-Jenkins suit rods that a spring or a leak holds: with an integrating rod their
// prediction drifts; `spoolwatch select` recommends a structure for a record.
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
  double window_s = 2.0;  ///< horizon of the checks below
  double stride_s = 0.1;
  double warmup_s = 0.0;
  double min_u_rms_V = 0.05;
  double max_saturated = 0.2;
  double max_missing = 0.2;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
};

}  // namespace estimator::fdi
