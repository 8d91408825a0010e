#include "estimator/fdi/glr.h"

#include <algorithm>
#include <cmath>

#include "estimator/fdi/average_run_length.h"

namespace estimator::fdi {
namespace {

class Glr final : public MeanChangeMethod {
 public:
  Glr(const GlrConfig& config, const MethodContext& context)
      : MeanChangeMethod(config, context),
        b_(glr_threshold(run_length(), static_cast<int>(config.window_blocks), mean_error())),
        z_(static_cast<std::size_t>(config.window_blocks)) {}

 private:
  Verdict test(double z) noexcept override {
    z_[next_] = z;
    next_ = next_ + 1 == z_.size() ? 0 : next_ + 1;
    filled_ = std::min(filled_ + 1, z_.size());
    Verdict best;
    double sum = 0.0;
    for (std::size_t n = 1; n <= filled_; ++n) {
      sum += z_[(next_ + z_.size() - n) % z_.size()];
      const double blocks = static_cast<double>(n);
      const double statistic = std::abs(sum) / std::sqrt(blocks) / b_;
      if (statistic > best.statistic) best = {statistic, sum / blocks, blocks};
    }
    return best;
  }
  void forget() noexcept override {
    next_ = filled_ = 0;
    forget_verdict();
  }
  void serialize_state(StateArchive& archive) override {
    archive.fixed(z_);
    archive.value(next_);
    archive.value(filled_);
    if (next_ >= z_.size() || filled_ > z_.size()) {
      next_ = filled_ = 0;
      archive.fail();
    }
    serialize_verdict(archive);
  }

  double b_;
  std::vector<double> z_;  ///< a ring
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
};

}  // namespace

void GlrConfig::visit(config::schema::Visitor& v) {
  visit_change(v);
  v.integer({"window_blocks", "longest age of a change, in blocks"}, window_blocks, {1, 10000});
}

std::unique_ptr<DetectionMethod> GlrConfig::make(const MethodContext& context) const {
  return std::make_unique<Glr>(*this, context);
}

}  // namespace estimator::fdi
