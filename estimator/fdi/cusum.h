// [[cusum]]: the cumulative sum test, for a shift of the mean of known size.
//
//   S+ = max(0, S+ + z - k),  S- = max(0, S- - z - k),  alarm when either reaches h
//
// z: standardised block mean (mean_change_method.h); k = shift_sigma/2 is optimal for a shift of
// shift_sigma; h follows from the mean time between false alarms. The sums saturate at 1.25 h so
// that an alarm returns soon after its cause; it returns at h/2. The shift is the mean of z since
// the sum was last zero, which is also the estimate of the time of change. Source: E. S. Page,
// Biometrika 41 (1954) 100; D. C. Montgomery, Statistical Quality Control, 9.1.
#pragma once

#include "estimator/fdi/mean_change_method.h"

namespace estimator::fdi {

struct CusumConfig final : MeanChangeConfig {
  double shift_sigma = 1.0;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] const char* list() const override { return "cusum"; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<CusumConfig>(*this);
  }
};

}  // namespace estimator::fdi
