#include "workbench/diagnose/progress_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <ostream>

#include "config/units/quantity.h"

namespace workbench::diagnose {
namespace {

constexpr std::chrono::milliseconds kPeriod{100};
constexpr std::size_t kRanked = 5;
constexpr std::size_t kColumns = 80;
constexpr const char* kWipe = "\r\x1b[K";

std::size_t columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kColumns;
}

std::string best_words(const selection::SearchProgress& progress, double noise_floor_m) {
  std::string floor = "noise floor " + config::units::length_words(noise_floor_m);
  if (progress.best.empty()) return floor;
  return "best " + progress.best + " " + config::units::length_words(progress.best_rms_m) + ", " +
         floor;
}

}  // namespace

ProgressLine::ProgressLine(std::ostream& out, bool renewed, double noise_floor_m)
    : out_(out),
      renewed_(renewed),
      motion_(config::units::motion()),
      noise_floor_m_(noise_floor_m) {}

void ProgressLine::rank(const selection::SearchProgress& progress) {
  if (progress.expected.empty() || progress.round == ranked_) return;
  ranked_ = progress.round;
  std::string names;
  for (std::size_t i = 0; i < std::min(kRanked, progress.expected.size()); ++i) {
    names += (i == 0 ? "" : ", ") + progress.expected[i];
  }
  out_ << (renewed_ ? kWipe : "") << "round " << progress.round
       << ": ranked by screening: " << names << std::endl;
}

void ProgressLine::show(const selection::SearchProgress& progress) {
  const config::units::PrintedAxis axis(motion_);
  rank(progress);
  if (!renewed_) {
    if (progress.round == round_ && progress.by_innovations == by_innovations_) return;
    round_ = progress.round;
    by_innovations_ = progress.by_innovations;
    out_ << (by_innovations_ ? "disturbed rig, round " : "round ") << progress.round << ": "
         << progress.of << " steps, " << best_words(progress, noise_floor_m_) << std::endl;
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kPeriod && progress.done < progress.of) return;
  last_ = now;
  std::string line = (progress.by_innovations ? "disturbed rig, round " : "round ") +
                     std::to_string(progress.round) +
                     (progress.screening ? ": screening " : ": fitting ") + progress.effect + ", " +
                     std::to_string(progress.done) + " of " + std::to_string(progress.of) + "; " +
                     best_words(progress, noise_floor_m_);
  line.resize(std::min(line.size(), columns() - 1));
  out_ << kWipe << line << std::flush;
}

void ProgressLine::end() {
  if (renewed_) out_ << kWipe << std::flush;
}

}  // namespace workbench::diagnose
