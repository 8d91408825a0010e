#include "estimator/fdi/trend.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/schema/error.h"
#include "estimator/fdi/block_method.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kNotByChance = 3.5;
constexpr double kReturned = 2.0;

class Trend final : public BlockMethod {
 public:
  Trend(const TrendConfig& config, const MethodContext& context)
      : BlockMethod({config.quantity}, config.block_s, context, config.where()),
        config_(config),
        trend_(make()) {}
  [[nodiscard]] std::vector<std::string> names() const override {
    return {"level", "slope_per_s", "time_to_limit_s"};
  }
  [[nodiscard]] std::vector<Alarm> declared_alarms() const override {
    Alarm alarm = config_.naming.alarm("drifting");
    alarm.parameter = config_.parameter;
    alarm.falls_with_parameter = config_.falls_with_parameter;
    alarm.low = std::isinf(config_.low) ? kNaN : config_.low;
    alarm.high = std::isinf(config_.high) ? kNaN : config_.high;
    return {alarm};
  }
  [[nodiscard]] AlarmInput alarm_input(std::size_t /*number*/) const noexcept override {
    AlarmInput input;
    input.value = trend_.level();
    input.std_error = trend_.level_error();
    if (!out_) {
      input.reason = "no drift that reaches a limit soon";
      return input;
    }
    input.severity = config_.naming.level();
    input.direction = trend_.slope() > 0.0 ? std::int8_t{1} : std::int8_t{-1};
    std::snprintf(reason_, sizeof reason_,
                  "%s drifts by %+.3g (+-%.1g) an hour from %.6g and reaches %.6g in %.3g h",
                  config_.quantity.c_str(), 3600.0 * trend_.slope(), 3600.0 * trend_.slope_error(),
                  trend_.level(), trend_.slope() > 0.0 ? config_.high : config_.low,
                  time_to_limit_s() / 3600.0);
    input.reason = reason_;
    return input;
  }

 private:
  [[nodiscard]] LocalTrend make() const {
    const double h = interval_s();
    return {config_.std_dev, config_.std_dev * config_.std_dev * h / std::pow(config_.memory_s, 4)};
  }
  [[nodiscard]] double time_to_limit_s() const noexcept {
    const double limit = trend_.slope() > 0.0 ? config_.high : config_.low;
    const double time_s = (limit - trend_.level()) / trend_.slope();
    return std::isnan(time_s) ? kUnlimited : std::max(time_s, 0.0);
  }
  void take(std::span<const double> means) noexcept override {
    trend_.add(means[0], interval_s());
    const double certain = std::abs(trend_.slope()) / trend_.slope_error();
    out_ = trend_.seen() > 2 && certain > (out_ ? kReturned : kNotByChance) &&
           time_to_limit_s() < config_.horizon_s;
  }
  void show(std::span<EstimatedValue> values) const noexcept override {
    const bool known = valid() && trend_.seen() > 1;
    values[0].value = valid() ? trend_.level() : kNaN;
    values[0].std_error = valid() ? trend_.level_error() : kNaN;
    values[1].value = known ? trend_.slope() : kNaN;
    values[1].std_error = known ? trend_.slope_error() : kNaN;
    values[2].value = known ? time_to_limit_s() : kNaN;
  }
  void forget() noexcept override {
    trend_ = make();
    out_ = false;
  }
  void serialize_state(StateArchive& archive) override {
    archive.value(trend_);
    archive.value(out_);
  }

  TrendConfig config_;
  LocalTrend trend_;
  bool out_ = false;
  mutable char reason_[200] = "";
};

}  // namespace

void LocalTrend::start(double value) noexcept {
  level_ = value;
  p11_ = variance_;
  far_off_ = 0;
}

void LocalTrend::add(double value, double step) noexcept {
  if (seen_ == 0) {
    start(value);
    seen_ = 1;
    return;
  }
  if (seen_ == 1) {
    // Two values fix the line exactly.
    slope_ = (value - level_) / step;
    level_ = value;
    p11_ = variance_;
    p12_ = variance_ / step;
    p22_ = 2.0 * variance_ / (step * step);
    seen_ = 2;
    return;
  }
  level_ += step * slope_;
  p11_ += step * (2.0 * p12_ + step * p22_) + q_ * step * step * step / 3.0;
  p12_ += step * p22_ + q_ * step * step / 2.0;
  p22_ += q_ * step;
  const double expected = std::sqrt(p11_ + variance_);
  double error = value - level_;
  if (std::abs(error) > kHuber * expected) {
    if (++far_off_ >= kNewLevel) return start(value);
    error = std::copysign(kHuber * expected, error);
  } else {
    far_off_ = 0;
  }
  const double k1 = p11_ / (expected * expected);
  const double k2 = p12_ / (expected * expected);
  level_ += k1 * error;
  slope_ += k2 * error;
  p22_ -= k2 * p12_;
  p12_ *= 1.0 - k1;
  p11_ *= 1.0 - k1;
  seen_ = std::min(seen_ + 1, 1000);
}

double LocalTrend::level_error() const noexcept { return std::sqrt(p11_); }
double LocalTrend::slope_error() const noexcept { return std::sqrt(p22_); }

void TrendConfig::visit(config::schema::Visitor& v) {
  visit_trained(v);
  v.text({"quantity", "monitored quantity", true}, quantity);
  v.number({"std_dev", "standard deviation of its block means, autocorrelation included"}, std_dev,
           {1e-300, kUnlimited});
  v.number({"memory_s", "memory of the trend"}, memory_s, {1e-3, 1e9});
  v.number({"horizon_s", "a limit reached sooner raises the alarm"}, horizon_s, {1e-3, 1e10});
  v.number({"low", "limit below, in the quantity's unit"}, low);
  v.number({"high", "limit above, in the quantity's unit"}, high);
  v.text({"parameter", "the physical parameter meant"}, parameter);
  v.boolean({"falls_with_parameter", "the quantity falls when the parameter rises"},
            falls_with_parameter);
  naming.visit(v);
}

std::unique_ptr<DetectionMethod> TrendConfig::make(const MethodContext& context) const {
  if (!(std_dev > 0.0)) {
    throw bad_config(where(), "is not trained", "std_dev, or file, from spoolwatch train");
  }
  if (!(block_s > 0.0)) throw bad_config(where() + ": block_s", "is not given", "a length");
  return std::make_unique<Trend>(*this, context);
}

}  // namespace estimator::fdi
