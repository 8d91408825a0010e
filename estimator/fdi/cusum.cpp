#include "estimator/fdi/cusum.h"

#include <algorithm>
#include <cmath>

#include "estimator/fdi/average_run_length.h"

namespace estimator::fdi {
namespace {

constexpr double kSaturation = 1.25;  ///< ratio to the threshold
/// Drift after the alarm, as a share of the shift found: smaller residues no longer accumulate, so
/// that the alarm of a large change returns soon after it.
constexpr double kResidualShift = 0.25;

class Cusum final : public MeanChangeMethod {
 public:
  Cusum(const CusumConfig& config, const MethodContext& context)
      : MeanChangeMethod(config, context),
        k_(0.5 * config.shift_sigma),
        h_(cusum_threshold(k_, run_length(), mean_error())) {}

 private:
  struct Side {
    double sum = 0.0;    ///< S
    double total = 0.0;  ///< sum of z since S was zero
    double blocks = 0.0;
    bool alarmed = false;
    [[nodiscard]] double mean() const noexcept { return blocks > 0.0 ? total / blocks : 0.0; }
    void add(double z, double k, double threshold) noexcept {
      const double drift = alarmed ? std::max(k, kResidualShift * mean()) : k;
      sum = std::min(sum + z - drift, kSaturation * threshold);
      total += z;
      blocks += 1.0;
      alarmed = alarmed || sum >= threshold;
      if (sum <= 0.0) *this = {};
    }
  };
  Verdict test(double z) noexcept override {
    up_.add(z, k_, h_);
    down_.add(-z, k_, h_);
    const bool is_up = up_.sum >= down_.sum;
    const Side& side = is_up ? up_ : down_;
    return {side.sum / h_, is_up ? side.mean() : -side.mean(), side.blocks};
  }
  void forget() noexcept override {
    up_ = down_ = {};
    forget_verdict();
  }
  void serialize_state(StateArchive& archive) override {
    archive.value(up_);
    archive.value(down_);
    serialize_verdict(archive);
  }

  double k_, h_;
  Side up_, down_;
};

}  // namespace

void CusumConfig::visit(config::schema::Visitor& v) {
  visit_change(v);
  v.number({"shift_sigma", "the shift looked for, in std_dev"}, shift_sigma, {0.01, 20.0});
}

std::unique_ptr<DetectionMethod> CusumConfig::make(const MethodContext& context) const {
  return std::make_unique<Cusum>(*this, context);
}

}  // namespace estimator::fdi
