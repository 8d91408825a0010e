// Common interface of the estimation methods: a batch per tumbling window, a sliding window, a
// recursion. Samples are preprocessed.
#pragma once

#include <memory>

#include "config/signals/sample.h"
#include "estimator/estimate.h"
#include "estimator/fdi/pipeline_config.h"
#include "estimator/state_archive.h"

namespace estimator::fdi {

class EstimationMethod {
 public:
  virtual ~EstimationMethod() = default;
  /// True when an estimate is due. A NaN is a missing sample.
  virtual bool push(double u_V, double y_m) noexcept = 0;
  /// `samples` are missing; true when an estimate became due meanwhile.
  virtual bool gap(long long samples) noexcept = 0;
  virtual void reset() noexcept = 0;
  virtual void serialize(StateArchive& archive) = 0;
  [[nodiscard]] virtual Estimate estimate() const noexcept = 0;
};

/// The method of `config.method`; `sample_time_s` after decimation. Throws schema::Error.
[[nodiscard]] std::unique_ptr<EstimationMethod> make_estimation_method(
    const EstimatorConfig& config, const Structure& structure, double sample_time_s);

/// A time as a whole number of samples, at least 1.
[[nodiscard]] int samples_in(double time_s, double sample_time_s) noexcept;

/// True while the loop holds the valve at null (arming states of sample_t): no motion to estimate
/// from.
[[nodiscard]] inline bool rests(const config::signals::Sample& sample) noexcept {
  constexpr std::uint8_t kDisarmed = 1;
  constexpr std::uint8_t kArmed = 2;
  constexpr std::uint8_t kLatched = 4;
  return sample.state == kDisarmed || sample.state == kArmed || sample.state == kLatched;
}

}  // namespace estimator::fdi
