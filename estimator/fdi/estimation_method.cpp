#include "estimator/fdi/estimation_method.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "estimator/preprocess.h"
#include "estimator/recursive.h"
#include "estimator/sliding_window.h"

namespace estimator::fdi {
namespace {

/// Slides by `stride`; with stride = window, a batch for each tumbling window.
class WindowedMethod final : public EstimationMethod {
 public:
  explicit WindowedMethod(const SlidingConfig& config) : window_(config) {}
  bool push(double u_V, double y_m) noexcept override { return window_.push(u_V, y_m); }
  bool gap(long long samples) noexcept override { return window_.gap(samples); }
  void reset() noexcept override { window_.reset(); }
  void serialize(StateArchive& archive) override { window_.serialize(archive); }
  [[nodiscard]] Estimate estimate() const noexcept override { return window_.estimate(); }

 private:
  SlidingWindow window_;
};

/// A batch for each tumbling window, with mean or straight line removed from u and y. The first
/// rows of a window have no history, since the previous window has another trend.
class DetrendedBatchMethod final : public EstimationMethod {
 public:
  DetrendedBatchMethod(const SlidingConfig& config, bool linear)
      : window_(config), linear_(linear), length_(config.window) {
    u_V_.reserve(length_);
    y_m_.reserve(length_);
  }
  bool push(double u_V, double y_m) noexcept override {
    u_V_.push_back(u_V);
    y_m_.push_back(std::isfinite(u_V) ? y_m : kNaN);
    if (u_V_.size() < length_) return false;
    finish();
    return true;
  }
  bool gap(long long samples) noexcept override {
    bool due = false;
    const auto lost = static_cast<std::size_t>(samples) % length_ +
                      (static_cast<std::size_t>(samples) >= length_ ? length_ : 0U);
    for (std::size_t i = 0; i < lost; ++i) due = push(kNaN, kNaN) || due;
    return due;
  }
  void reset() noexcept override {
    u_V_.clear();
    y_m_.clear();
    window_.reset();
  }
  void serialize(StateArchive& archive) override {
    window_.serialize(archive);
    archive.growing(u_V_, length_);
    archive.growing(y_m_, length_);
    archive.value(estimate_);
  }
  [[nodiscard]] Estimate estimate() const noexcept override { return estimate_; }

 private:
  void finish() noexcept {
    for (std::vector<double>* values : {&u_V_, &y_m_}) {
      if (linear_) {
        remove_line(*values);
      } else {
        remove_mean(*values);
      }
    }
    window_.reset();
    for (std::size_t i = 0; i < length_; ++i) window_.push(u_V_[i], y_m_[i]);
    estimate_ = window_.estimate();
    u_V_.clear();
    y_m_.clear();
  }

  SlidingWindow window_;
  bool linear_;
  std::size_t length_;
  std::vector<double> u_V_;
  std::vector<double> y_m_;
  Estimate estimate_;
};

class RecursiveMethod final : public EstimationMethod {
 public:
  RecursiveMethod(const RecursiveConfig& config, int stride)
      : recursion_(config), stride_(stride) {}
  bool push(double u_V, double y_m) noexcept override {
    recursion_.push(u_V, y_m);
    return advance(1);
  }
  bool gap(long long samples) noexcept override {
    recursion_.gap();
    return advance(samples);
  }
  void reset() noexcept override {
    recursion_.reset();
    since_ = 0;
  }
  void serialize(StateArchive& archive) override {
    recursion_.serialize(archive);
    archive.value(since_);
  }
  [[nodiscard]] Estimate estimate() const noexcept override { return recursion_.estimate(); }

 private:
  bool advance(long long samples) noexcept {
    since_ += samples;
    const bool due = since_ >= stride_;
    since_ %= stride_;
    return due;
  }

  Recursive recursion_;
  long long stride_;
  long long since_ = 0;
};

}  // namespace

int samples_in(double time_s, double sample_time_s) noexcept {
  return static_cast<int>(std::clamp(std::round(time_s / sample_time_s), 1.0, 1e8));
}

std::unique_ptr<EstimationMethod> make_estimation_method(const EstimatorConfig& config,
                                                         const Structure& structure,
                                                         double sample_time_s) {
  Limits limits;
  limits.max_condition = config.max_condition;
  const int window = samples_in(config.window_s, sample_time_s);
  const int stride = samples_in(config.stride_s, sample_time_s);
  if (config.method == "recursive") {
    RecursiveConfig recursive;
    recursive.structure = structure;
    recursive.forgetting = config.forgetting;
    recursive.prior_variance = config.prior_variance;
    recursive.warmup =
        config.first_batch_s > 0.0 ? samples_in(config.first_batch_s, sample_time_s) : 0;
    recursive.gate_window = window;
    recursive.limits = limits;
    return std::make_unique<RecursiveMethod>(recursive, stride);
  }
  const SlidingConfig sliding{structure, window, config.method == "sliding" ? stride : window,
                              limits};
  if (config.detrend != "none") {
    return std::make_unique<DetrendedBatchMethod>(sliding, config.detrend == "linear");
  }
  return std::make_unique<WindowedMethod>(sliding);
}

}  // namespace estimator::fdi
