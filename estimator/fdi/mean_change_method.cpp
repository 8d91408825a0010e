#include "estimator/fdi/mean_change_method.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/schema/error.h"
#include "estimator/fdi/average_run_length.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;

constexpr double kOneSided95 = 1.645;
/// The alarm returns when the statistic has fallen to this share of the threshold.
constexpr double kGone = 0.5;

}  // namespace

void MeanChangeConfig::visit_change(config::schema::Visitor& v) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  visit_trained(v);
  v.text({"quantity", "monitored quantity: ESTIMATOR.b1, sample.following_error_m, ...", true},
         quantity);
  v.number({"false_alarm_time_s", "mean time between false alarms"}, false_alarm_time_s,
           {1e-3, 1e10});
  v.number({"mean", "healthy mean of the quantity"}, mean);
  v.number({"std_dev", "standard deviation of its block means, autocorrelation included"}, std_dev,
           {1e-300, kInfinity});
  v.number({"mean_error", "standard error of mean"}, mean_error, {0.0, kInfinity});
  v.text({"parameter", "the physical parameter meant"}, parameter);
  v.boolean({"falls_with_parameter", "the quantity falls when the parameter rises"},
            falls_with_parameter);
  v.texts({"ambiguity_group", "parameters that this quantity cannot separate"}, ambiguity_group);
  naming.visit(v);
}

void MeanChangeConfig::adopt(const TrainedMethod& trained) {
  const TrainedClass& healthy = *trained.healthy();
  mean = healthy.mean[0];
  std_dev = healthy.long_run[0];
  mean_error = std_dev / std::sqrt(static_cast<double>(healthy.blocks));
}

MeanChangeMethod::MeanChangeMethod(const MeanChangeConfig& config, const MethodContext& context)
    : BlockMethod({config.quantity}, config.block_s, context, config.where()) {
  if (!std::isfinite(config.mean) || !(config.std_dev > 0.0)) {
    throw bad_config(config.where(), "is not trained",
                     "mean and std_dev, or file, from spoolwatch train");
  }
  if (!(interval_s() > 0.0)) {
    throw bad_config(config.where() + ": block_s",
                     "is not given and " + config.quantity + " comes irregularly",
                     "the length of a block");
  }
  if (!(config.false_alarm_time_s > 10.0 * interval_s())) {
    throw bad_config(config.where() + ": false_alarm_time_s", "is less than ten blocks");
  }
  config_ = std::shared_ptr<const MeanChangeConfig>(
      static_cast<const MeanChangeConfig*>(config.clone().release()));
}

double MeanChangeMethod::run_length() const noexcept {
  return config_->false_alarm_time_s / interval_s();
}

double MeanChangeMethod::mean_error() const noexcept {
  return kOneSided95 * config_->mean_error / config_->std_dev;
}

std::vector<Alarm> MeanChangeMethod::declared_alarms() const {
  Alarm alarm = config_->naming.alarm("changed");
  alarm.parameter = config_->parameter;
  alarm.falls_with_parameter = config_->falls_with_parameter;
  alarm.ambiguity_group = config_->ambiguity_group;
  return {alarm};
}

void MeanChangeMethod::take(std::span<const double> means) noexcept {
  verdict_ = test((means[0] - config_->mean) / config_->std_dev);
  out_ = verdict_.statistic >= (out_ ? kGone : 1.0);
}

void MeanChangeMethod::show(std::span<NamedValue> values) const noexcept {
  values[0].value = valid() ? verdict_.statistic : kNaN;
  values[1].value = valid() ? verdict_.shift * config_->std_dev : kNaN;
  values[1].std_error =
      verdict_.blocks > 0.0 ? config_->std_dev / std::sqrt(verdict_.blocks) : kNaN;
  values[2].value = valid() ? verdict_.blocks * interval_s() : kNaN;
}

AlarmInput MeanChangeMethod::alarm_input(std::size_t /*number*/) const noexcept {
  AlarmInput input;
  const double shift = verdict_.shift * config_->std_dev;
  input.value = config_->mean + shift;
  input.std_error = config_->std_dev / std::sqrt(std::fmax(verdict_.blocks, 1.0));
  if (!out_) {
    input.reason = "the mean is the healthy one";
    return input;
  }
  input.severity = config_->naming.level();
  input.direction = shift > 0.0 ? std::int8_t{1} : std::int8_t{-1};
  std::snprintf(reason_, sizeof reason_, "%s has changed by %+.3g (+-%.1g) from %.6g, %.3g s ago",
                config_->quantity.c_str(), shift, input.std_error, config_->mean,
                verdict_.blocks * interval_s());
  input.reason = reason_;
  return input;
}

void MeanChangeMethod::serialize_verdict(StateArchive& archive) {
  archive.value(verdict_);
  archive.value(out_);
}

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
