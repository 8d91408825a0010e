// Latest samples since the last gap, as many as a window and its lead-in need.
#pragma once

#include <cstddef>
#include <vector>

#include "config/signals/pressures.h"
#include "estimator/greybox/tracking/window_fit.h"
#include "estimator/state_archive.h"

namespace estimator::greybox::tracking {

class SampleBuffer {
 public:
  SampleBuffer(std::size_t lead, std::size_t window);

  /// Drops all samples: a gap follows.
  void clear() noexcept { kept_ = 0; }
  /// Amortised: copies a window once per window length.
  void push(double u_V, double y_m, const config::signals::Pressures& pressures);

  [[nodiscard]] std::size_t needed() const noexcept { return needed_; }
  [[nodiscard]] bool enough() const noexcept { return kept_ >= needed_; }
  /// Latest samples with the lead-in before them; with chamber pressures where both were read
  /// throughout.
  [[nodiscard]] WindowData latest(std::size_t samples) const noexcept;
  /// Supply pressures of the latest samples; null unless read throughout.
  [[nodiscard]] const double* supply_Pa(std::size_t samples) const noexcept;

  /// Bit-exact (state_archive.h).
  void serialize(estimator::StateArchive& archive);

 private:
  std::size_t lead_;
  std::size_t needed_;
  std::vector<double> u_V_;  ///< twice the needed length
  std::vector<double> y_m_;
  std::vector<double> supply_Pa_;  ///< NaN: not read; same for the two below
  std::vector<double> in_Pa_;
  std::vector<double> out_Pa_;
  std::size_t kept_ = 0;  ///< samples kept since the last gap
};

}  // namespace estimator::greybox::tracking
