// The latest samples of the rig since the last gap, as many as a window and its lead-in need.
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

  /// Nothing before now belongs together with what comes.
  void clear() noexcept { kept_ = 0; }
  /// Copies a window once in as many samples.
  void push(double u_V, double y_m, const config::signals::Pressures& pressures);

  [[nodiscard]] std::size_t needed() const noexcept { return needed_; }
  [[nodiscard]] bool enough() const noexcept { return kept_ >= needed_; }
  /// The latest, with the lead-in before them; with chamber pressures where both were read in all.
  [[nodiscard]] WindowData latest(std::size_t samples) const noexcept;
  /// Their supply pressures; null unless it was read in all of them.
  [[nodiscard]] const double* supply_Pa(std::size_t samples) const noexcept;

  /// Bit for bit (state_archive.h).
  void serialize(estimator::StateArchive& archive);

 private:
  std::size_t lead_;
  std::size_t needed_;
  std::vector<double> u_V_;  ///< twice as long as needed
  std::vector<double> y_m_;
  std::vector<double> supply_Pa_;  ///< NaN: not read; as the two below
  std::vector<double> in_Pa_;
  std::vector<double> out_Pa_;
  std::size_t kept_ = 0;  ///< since the last gap that are still there
};

}  // namespace estimator::greybox::tracking
