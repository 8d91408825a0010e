// [[voter]]: two or three channels of the same quantity, which of them is out, since when, and the
// value that may still be trusted.
//
// Three: the middle value is right as long as no two channels fail in the same way; a channel that
// differs from it by more than `tolerance` for `confirm_s` is out and stays out until it agrees
// again for `return_s`. With one out, the remaining two are compared: when they differ, it cannot
// be said which is wrong, and the value is not valid. Two channels from the start: the same, except
// that a channel whose reading is missing is out by itself. Agreed value: the middle of three, the
// mean of two, the only one left. Where all
// were missing, those that are there and agree for `return_s` come back together; one alone does
// unless it was outvoted. Source: Song
// 2002, chapter 2 (redundant sensors); J. H. Lala, R. E. Harper, Proceedings of the IEEE 82 (1994)
// 25 (mid-value select).
#pragma once

#include <array>

#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Values: value, spread (greatest less least of the channels in), out (number of the channel that
/// is out, from 1; 0: none, -1: they disagree and nobody knows which).
struct VoterConfig final : DetectionMethodConfigOf<VoterConfig> {
  std::vector<std::string> channels;  ///< quantities, two or three
  double tolerance = 0.0;
  double confirm_s = 0.1;
  double return_s = 5.0;
  double stride_s = 0.1;  ///< between two findings; a change is told at once
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> inputs() const override { return channels; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
};

/// The vote by itself, once a sample.
class Vote {
 public:
  struct Rules {
    double tolerance;
    std::int64_t confirm, comes_back;  ///< samples
  };
  struct Channel {
    std::int64_t against = 0;  ///< samples in a row outside, or inside while it is out
    bool out = false;
    bool missed = false;     ///< it left because it was missing, not because it differed
    std::int64_t since = 0;  ///< sample at which it left
  };
  explicit Vote(std::size_t channels, Rules rules) : rules_(rules), count_(channels) {}

  /// NaN: missing. True when a channel has left or come back, or agreement was lost or found.
  bool take(std::span<const double> values) noexcept;
  void reset() noexcept;
  [[nodiscard]] double value() const noexcept { return value_; }  ///< NaN: nobody knows
  [[nodiscard]] double spread() const noexcept { return spread_; }
  [[nodiscard]] bool disagree() const noexcept { return disagree_; }
  [[nodiscard]] const Channel& channel(std::size_t i) const noexcept { return channels_[i]; }
  /// Samples since the first channel that is out left; 0: none is.
  [[nodiscard]] std::int64_t taken() const noexcept { return taken_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  [[nodiscard]] bool judge(std::size_t i, bool wrong, bool missing) noexcept;

  Rules rules_;
  std::size_t count_;
  std::array<Channel, 3> channels_{};
  std::int64_t taken_ = 0;
  std::int64_t apart_ = 0;  ///< samples in a row that two channels differ
  bool disagree_ = false;
  double value_ = kNaN;
  double spread_ = kNaN;
};

}  // namespace estimator::fdi
