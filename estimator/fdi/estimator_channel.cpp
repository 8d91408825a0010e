#include "estimator/fdi/estimator_channel.h"

#include <cmath>

#include "config/schema/error.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;
using config::schema::Error;

PreprocessConfig preprocess_config(const EstimatorConfig& config, double sample_time_s) {
  PreprocessConfig out;
  out.offset_y_m = config.offset_m;
  out.filter = config.filter != "none";
  out.design.band = config.filter == "low"    ? Band::low_pass
                    : config.filter == "high" ? Band::high_pass
                                              : Band::band_pass;
  out.design.low_Hz = config.filter_low_Hz;
  out.design.high_Hz = config.filter_high_Hz;
  out.design.sample_Hz = 1.0 / sample_time_s;
  out.decimation = static_cast<int>(config.decimation);
  return out;
}

/// Adds the place to errors of the estimator library, which knows no file.
template <class F>
auto in_table(const EstimatorConfig& config, F&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw bad_config("[[estimator]] " + config.id, error.what());
  }
}

}  // namespace

EstimatorChannel::EstimatorChannel(const EstimatorConfig& config, double sample_time_s)
    : config_(config),
      structure_(
          in_table(config, [&] { return parse_structure(config.structure, config.constant); })),
      preprocess_(
          in_table(config, [&] { return Preprocess(preprocess_config(config, sample_time_s)); })),
      initial_preprocess_(preprocess_),
      method_(in_table(config,
                       [&] {
                         return make_estimation_method(
                             config, structure_,
                             sample_time_s * static_cast<double>(config.decimation));
                       })),
      monitor_(static_cast<std::size_t>(
          samples_in(config.window_s, sample_time_s * static_cast<double>(config.decimation)))),
      warmup_samples_(std::llround(config.warmup_s / sample_time_s)),
      window_samples_(samples_in(config.window_s, sample_time_s)) {
  if (config.detrend != "none" && config.method != "batch") {
    throw bad_config("[[estimator]] " + config.id + ": detrend",
                     "needs whole windows, the method is " + config.method, "method = \"batch\"");
  }
}

bool EstimatorChannel::on_gap(std::int64_t periods) noexcept {
  samples_ += periods;
  previous_y_m_ = kNaN;
  saturated_ = false;
  const std::int64_t lost = preprocess_.gap(periods);
  if (lost == 0) return false;
  for (std::int64_t i = 0; i < lost && !(i > 0 && monitor_.missing_share() >= 1.0); ++i) {
    monitor_.push_missing();
  }
  return method_->gap(lost);
}

bool EstimatorChannel::push(const config::signals::Sample& sample, double y_m) noexcept {
  samples_ = rests(sample) ? 0 : samples_ + 1;
  saturated_ = saturated_ || sample.saturated;
  if (!preprocess_.push(sample.u_applied_V, y_m)) return false;
  const bool due = feed(preprocess_.u_V(), preprocess_.y_m(), saturated_);
  saturated_ = false;
  return due;
}

bool EstimatorChannel::feed(double u_V, double y_m, bool saturated) noexcept {
  if (!std::isfinite(u_V) || !std::isfinite(y_m)) {
    monitor_.push_missing();
    previous_y_m_ = kNaN;
    return method_->push(kNaN, kNaN);
  }
  monitor_.push(u_V, saturated);
  if (!config_.increments) return method_->push(u_V, y_m);
  const double increment_m = y_m - previous_y_m_;
  previous_y_m_ = y_m;
  return method_->push(u_V, increment_m);
}

void EstimatorChannel::reset() {
  preprocess_ = initial_preprocess_;
  method_->reset();
  monitor_.reset();
  samples_ = 0;
  previous_y_m_ = kNaN;
  saturated_ = false;
}

void EstimatorChannel::serialize(StateArchive& archive) {
  archive.value(preprocess_);
  method_->serialize(archive);
  monitor_.serialize(archive);
  archive.value(samples_);
  archive.value(previous_y_m_);
  archive.value(saturated_);
}

bool EstimatorChannel::warming_up() const noexcept {
  return samples_ <= warmup_samples_ || samples_ < window_samples_ || !monitor_.full();
}

Estimate EstimatorChannel::estimate() const noexcept {
  Estimate found = method_->estimate();
  Reason reason = found.valid ? Reason::none : found.reason;
  if (!monitor_.full()) {
    reason = Reason::too_short;
  } else if (monitor_.missing_share() > config_.max_missing) {
    reason = Reason::gap;
  } else if (monitor_.saturated_share() > config_.max_saturated) {
    reason = Reason::saturated;
  } else if (found.valid && monitor_.u_rms_V() < config_.min_u_rms_V) {
    reason = Reason::not_excited;
  }
  found.valid = reason == Reason::none;
  found.reason = reason;
  return found;
}

MethodOutput EstimatorChannel::evaluate(std::span<EstimatedValue> values) noexcept {
  const Estimate found = estimate();
  const int size = structure_.size();
  for (int i = 0; i < size; ++i) {
    EstimatedValue& v = values[static_cast<std::size_t>(i)];
    v.value = i < found.size ? found.value[i] : kNaN;
    v.std_error = i < found.size ? found.std_error[i] : kNaN;
  }
  values[static_cast<std::size_t>(size)].value = found.residual_rms_m;
  values[static_cast<std::size_t>(size) + 1].value = found.condition;
  return {found.valid, warming_up(), to_string(found.reason), found.condition, found.samples};
}

}  // namespace estimator::fdi
