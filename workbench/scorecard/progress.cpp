#include "workbench/scorecard/progress.h"

#include <fmt/format.h>

#include <ostream>

namespace workbench::scorecard {
namespace {

std::string clock(double time_s) {
  const auto whole = static_cast<long>(time_s);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

ScorecardProgress::ScorecardProgress(std::ostream& out, bool renewed, std::size_t parts,
                                     double work)
    : out_(out), renewed_(renewed), parts_(parts), all_(work) {}

void ScorecardProgress::add(double work, const std::string& part) {
  ++done_;
  worked_ += work;
  const double share = all_ > 0.0 ? worked_ / all_ : 1.0;
  if (!renewed_ && static_cast<int>(10.0 * share) <= tenths_) return;
  tenths_ = static_cast<int>(10.0 * share);
  const double passed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  const double left_s = share > 0.0 ? passed_s * (1.0 - share) / share : 0.0;
  out_ << (renewed_ ? "\r\x1b[K" : "") << "scorecard: " << done_ << " of " << parts_ << " parts, "
       << clock(passed_s) << ", " << clock(left_s) << " left" << (renewed_ ? ", " + part : "\n")
       << std::flush;
}

void ScorecardProgress::end() {
  if (renewed_ && done_ > 0) out_ << "\r\x1b[K" << std::flush;
}

}  // namespace workbench::scorecard
