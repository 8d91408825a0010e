// [[glr]]: the generalised likelihood ratio test, for a shift of the mean of unknown size.
//
//   G = max over n = 1..window_blocks of |z(t) + ... + z(t-n+1)| / sqrt(n),  alarm when G >= b
//
// z: standardised block mean (mean_change_method.h). The maximising n estimates the time of
// change, the mean of those n its size. A large change is detected within one block, a small one
// within at most window_blocks. Source: M. Basseville, I. V. Nikiforov, Detection of Abrupt
// Changes, 1993, 2.4.3; window: T. L. Lai, Journal of the Royal Statistical Society B 57 (1995)
// 613.
#pragma once

#include "estimator/fdi/mean_change_method.h"

namespace estimator::fdi {

struct GlrConfig final : MeanChangeConfig {
  std::int64_t window_blocks = 64;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] const char* list() const override { return "glr"; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
  [[nodiscard]] std::unique_ptr<DetectionMethodConfig> clone() const override {
    return std::make_unique<GlrConfig>(*this);
  }
};

}  // namespace estimator::fdi
