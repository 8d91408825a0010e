#include "estimator/preprocess.h"

#include <cmath>
#include <string>

#include "config/schema/error.h"
#include "config/signals/nan.h"

namespace estimator {
namespace {

using config::signals::kNaN;

Filter anti_alias(int factor) {
  if (factor < 1) {
    throw config::schema::UsageError("decimation " + std::to_string(factor) +
                                     "; allowed: at least 1");
  }
  if (factor == 1) return {};
  return Filter(FilterDesign{.band = Band::low_pass,
                             .order = 8,
                             .low_Hz = 0.0,
                             .high_Hz = 0.8 * 0.5 / factor,
                             .sample_Hz = 1.0});
}

}  // namespace

double remove_mean(std::span<double> values) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double v : values) {
    if (std::isnan(v)) continue;
    sum += v;
    ++count;
  }
  const double mean = count > 0 ? sum / static_cast<double>(count) : 0.0;
  for (double& v : values) v -= mean;
  return mean;
}

Line remove_line(std::span<double> values) {
  // Index and value about their means: no cancellation for long records.
  double index = 0.0;
  double value = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    index += static_cast<double>(i);
    value += values[i];
    count += 1.0;
  }
  if (count == 0.0) return {};
  index /= count;
  value /= count;
  double square = 0.0;
  double product = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    const double x = static_cast<double>(i) - index;
    square += x * x;
    product += x * (values[i] - value);
  }
  const double slope = square > 0.0 ? product / square : 0.0;
  const Line line{value - slope * index, slope};
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] -= line.offset + line.slope * static_cast<double>(i);
  }
  return line;
}

void apply_filter(Filter filter, std::span<double> values) {
  filter.reset();
  for (double& v : values) {
    if (std::isnan(v)) {
      filter.reset();
    } else {
      v = filter.push(v);
    }
  }
}

std::vector<double> decimate(std::span<const double> values, int factor) {
  std::vector<double> all(values.begin(), values.end());
  apply_filter(anti_alias(factor), all);
  std::vector<double> out;
  for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(factor)) {
    out.push_back(all[i]);
  }
  return out;
}

Preprocess::Preprocess(const PreprocessConfig& config)
    : config_(config), alias_u_(anti_alias(config.decimation)), alias_y_(alias_u_) {
  if (config.filter) filter_u_ = filter_y_ = Filter(config.design);
}

bool Preprocess::push(double u_V, double y_m) noexcept {
  double u = kNaN;
  double y = kNaN;
  if (std::isfinite(u_V) && std::isfinite(y_m)) {
    u = alias_u_.push(filter_u_.push(u_V - config_.offset_u_V));
    y = alias_y_.push(filter_y_.push(y_m - config_.offset_y_m));
  } else {
    restart();
    broken_ = true;
  }
  const bool keep = phase_ == 0;
  phase_ = phase_ + 1 == config_.decimation ? 0 : phase_ + 1;
  if (!keep) return false;
  u_V_ = broken_ ? kNaN : u;
  y_m_ = broken_ ? kNaN : y;
  broken_ = false;
  return true;
}

long long Preprocess::gap(long long samples) noexcept {
  if (samples <= 0) return 0;
  restart();
  const long long to_next = phase_ == 0 ? 0 : config_.decimation - phase_;
  const long long lost =
      samples > to_next ? (samples - to_next + config_.decimation - 1) / config_.decimation : 0;
  phase_ = static_cast<int>((phase_ + samples) % config_.decimation);
  broken_ = lost == 0 || phase_ != 0;
  return lost;
}

void Preprocess::restart() noexcept {
  filter_u_.reset();
  filter_y_.reset();
  alias_u_.reset();
  alias_y_.reset();
}

}  // namespace estimator
