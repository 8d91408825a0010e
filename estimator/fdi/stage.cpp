#include "estimator/fdi/stage.h"

#include <cmath>
#include <limits>

#include "config/schema/error.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;
using config::schema::Error;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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

/// Errors of the estimator library, which knows no file, with the place.
template <class F>
auto in_table(const EstimatorConfig& config, F&& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw bad_config("[[estimator]] " + config.id, error.what());
  }
}

}  // namespace

Stage::Stage(const EstimatorConfig& config, double sample_time_s)
    : config_(config),
      structure_(
          in_table(config, [&] { return parse_structure(config.structure, config.constant); })),
      preprocess_(
          in_table(config, [&] { return Preprocess(preprocess_config(config, sample_time_s)); })),
      fresh_(preprocess_),
      engine_(in_table(config,
                       [&] {
                         return make_engine(config, structure_,
                                            sample_time_s * static_cast<double>(config.decimation));
                       })),
      monitor_(static_cast<std::size_t>(
          samples_in(config.window_s, sample_time_s * static_cast<double>(config.decimation)))),
      warmup_samples_(std::llround(config.warmup_s / sample_time_s)),
      previous_y_m_(kNan) {
  if (config.detrend != "none" && config.method != "batch") {
    throw bad_config("[[estimator]] " + config.id + ": detrend",
                     "needs whole windows, the method is " + config.method, "method = \"batch\"");
  }
}

bool Stage::lose(std::int64_t periods) noexcept {
  samples_ += periods;
  previous_y_m_ = kNan;
  saturated_ = false;
  const std::int64_t lost = preprocess_.gap(periods);
  if (lost == 0) return false;
  for (std::int64_t i = 0; i < lost && !(i > 0 && monitor_.missing_share() >= 1.0); ++i) {
    monitor_.push_missing();
  }
  return engine_->gap(lost);
}

bool Stage::push(double u_V, double y_m, bool saturated) noexcept {
  ++samples_;
  saturated_ = saturated_ || saturated;
  if (!preprocess_.push(u_V, y_m)) return false;
  const bool due = feed(preprocess_.u_V(), preprocess_.y_m(), saturated_);
  saturated_ = false;
  return due;
}

bool Stage::feed(double u_V, double y_m, bool saturated) noexcept {
  if (!std::isfinite(u_V) || !std::isfinite(y_m)) {
    monitor_.push_missing();
    previous_y_m_ = kNan;
    return engine_->push(kNan, kNan);
  }
  monitor_.push(u_V, saturated);
  if (!config_.increments) return engine_->push(u_V, y_m);
  const double increment_m = y_m - previous_y_m_;
  previous_y_m_ = y_m;
  return engine_->push(u_V, increment_m);
}

void Stage::reset() {
  preprocess_ = fresh_;
  engine_->reset();
  monitor_.reset();
  samples_ = 0;
  previous_y_m_ = kNan;
  saturated_ = false;
}

void Stage::serialize(StateArchive& archive) {
  archive.value(preprocess_);
  engine_->serialize(archive);
  monitor_.serialize(archive);
  archive.value(samples_);
  archive.value(previous_y_m_);
  archive.value(saturated_);
}

bool Stage::warming_up() const noexcept { return samples_ <= warmup_samples_ || !monitor_.full(); }

Estimate Stage::estimate() const noexcept {
  Estimate found = engine_->estimate();
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

}  // namespace estimator::fdi
