// Progress of a scorecard: one line that is renewed on a terminal, a line for each tenth elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <iosfwd>
#include <string>

namespace workbench::scorecard {

/// Not for several threads at once.
class ScorecardProgress {
 public:
  /// `renewed`: `out` is a terminal. `work`: of all parts, any unit. The stream must outlive this.
  ScorecardProgress(std::ostream& out, bool renewed, std::size_t parts, double work);

  void add(double work, const std::string& part);
  /// Wipes the renewed line.
  void end();

 private:
  std::ostream& out_;
  bool renewed_;
  std::size_t parts_;
  double all_;
  std::size_t done_ = 0;
  double worked_ = 0.0;
  int tenths_ = 0;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace workbench::scorecard
