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

void MeanChangeMethod::show(std::span<EstimatedValue> values) const noexcept {
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

}  // namespace estimator::fdi
