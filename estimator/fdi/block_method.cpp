#include "estimator/fdi/block_method.h"

#include <algorithm>
#include <cmath>

namespace estimator::fdi {

BlockMethod::BlockMethod(const std::vector<std::string>& quantities, double block_s,
                         const MethodContext& context, const std::string& where)
    : sums_(quantities.size()), means_(quantities.size()) {
  for (const std::string& quantity : quantities) {
    inputs_.push_back(context.inputs.find(quantity, where));
  }
  if (block_s > 0.0) {
    length_ = std::max<std::int64_t>(1, std::llround(block_s / context.sample_time_s));
    interval_s_ = static_cast<double>(length_) * context.sample_time_s;
  } else {
    interval_s_ = inputs_.front().interval_s();
  }
}

bool BlockMethod::on_gap(std::int64_t periods) noexcept {
  samples_ += periods;
  if (length_ == 0 || samples_ < length_) return false;
  samples_ %= length_;
  std::fill(sums_.begin(), sums_.end(), Sum{});
  return false;
}

bool BlockMethod::push(const config::signals::Sample& /*sample*/, double /*y_m*/) noexcept {
  ++samples_;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (!inputs_[i].fresh()) continue;
    ++sums_[i].fresh;
    if (!inputs_[i].usable()) continue;
    ++sums_[i].usable;
    sums_[i].sum += inputs_[i].value();
  }
  if (length_ == 0 ? sums_.front().fresh == 0 : samples_ < length_) return false;
  samples_ = 0;
  return close();
}

bool BlockMethod::close() noexcept {
  valid_ = true;
  unusable_ = nullptr;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const bool enough = sums_[i].usable > 0 && 2 * sums_[i].usable >= sums_[i].fresh;
    if (!enough && unusable_ == nullptr) unusable_ = &inputs_[i];
    means_[i] = sums_[i].sum / static_cast<double>(sums_[i].usable);
    sums_[i] = Sum{};
  }
  valid_ = unusable_ == nullptr;
  warming_up_ = warming_up_ && !valid_;
  if (valid_) take(means_);
  return true;
}

MethodOutput BlockMethod::evaluate(std::span<EstimatedValue> values) noexcept {
  show(values);
  MethodOutput found;
  found.valid = valid_;
  // Warming up lasts as long as an input warms up; an input that never becomes usable is INVALID.
  found.warming_up = warming_up_ && unusable_ != nullptr && unusable_->warming_up();
  found.reason = valid_ ? "" : unusable_ != nullptr ? unusable_->why() : "no block yet";
  return found;
}

void BlockMethod::reset() {
  std::fill(sums_.begin(), sums_.end(), Sum{});
  samples_ = 0;
  valid_ = false;
  warming_up_ = true;
  unusable_ = nullptr;
  forget();
}

void BlockMethod::serialize(StateArchive& archive) {
  archive.fixed(sums_);
  archive.fixed(means_);
  archive.value(samples_);
  archive.value(valid_);
  archive.value(warming_up_);
  serialize_state(archive);
}

}  // namespace estimator::fdi
