// Progress of a diagnosis: one line that is renewed on a terminal, elsewhere one line per round.
#pragma once

#include <chrono>
#include <iosfwd>

#include "config/units/quantity.h"
#include "estimator/greybox/selection/problem.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

class ProgressLine {
 public:
  /// `renewed`: `out` is a terminal. The stream must outlive this object. Prints as the axis that
  /// its maker prints.
  ProgressLine(std::ostream& out, bool renewed, double noise_floor_m);

  /// From any thread, one at a time.
  void show(const selection::SearchProgress& progress);
  /// Wipes the renewed line.
  void end();

 private:
  void rank(const selection::SearchProgress& progress);

  std::ostream& out_;
  bool renewed_;
  config::units::Motion motion_;
  double noise_floor_m_;
  int round_ = 0;  ///< latest round whose line was written
  bool by_innovations_ = false;
  int ranked_ = 0;  ///< latest round whose ranking was written
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace workbench::diagnose
