// How far a diagnosis is: one line that is renewed on a terminal, a line for each round elsewhere.
#pragma once

#include <chrono>
#include <iosfwd>
#include <string>

#include "estimator/greybox/selection/problem.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

class ProgressLine {
 public:
  /// `renewed`: `out` is a terminal. The stream must outlive this object.
  ProgressLine(std::ostream& out, bool renewed, double noise_floor_m);

  void show(const selection::SearchProgress& progress);
  /// Wipes the renewed line.
  void end();

 private:
  void rank(const selection::SearchProgress& progress);

  std::ostream& out_;
  bool renewed_;
  double noise_floor_m_;
  std::string round_;   ///< of which a line has been written
  std::string ranked_;  ///< of which the quick look has been written
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace workbench::diagnose
