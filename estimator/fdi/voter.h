// [[voter]]: two or three redundant channels of one quantity: which channel is voted out, since
// when, and the value that may still be trusted.
//
// Three channels: the middle value is right as long as no two channels fail in the same way; a
// channel that differs from it by more than `tolerance` for `confirm_s` is voted out until it
// agrees again for `return_s`. With one out, the remaining two are compared: when they differ, the
// wrong one cannot be identified, and the value is invalid. Two channels: likewise, except that a
// channel with a missing reading is out. Agreed value: the middle of three, the mean of two, or the
// only one left. After all were missing, present channels that agree for `return_s` return
// together; a single one returns unless it was outvoted. Source: Song 2002, chapter 2 (redundant
// sensors); J. H. Lala, R. E. Harper, Proceedings of the IEEE 82 (1994) 25 (mid-value select).
#pragma once

#include <array>

#include "estimator/fdi/trained.h"

namespace estimator::fdi {

/// Values: value, spread (greatest minus least of the channels in use), out (number of the channel
/// voted out, from 1; 0: none, -1: the channels disagree and the wrong one is unknown).
struct VoterConfig final : DetectionMethodConfigOf<VoterConfig> {
  std::vector<std::string> channels;  ///< quantities, two or three
  double tolerance = 0.0;
  double confirm_s = 0.1;
  double return_s = 5.0;
  double stride_s = 0.1;  ///< between two outputs; a change is reported at once
  AlarmNaming naming;

  void visit(config::schema::Visitor& v) override;
  [[nodiscard]] std::vector<std::string> inputs() const override { return channels; }
  [[nodiscard]] std::unique_ptr<DetectionMethod> make(const MethodContext& context) const override;
};

/// The vote alone, once per sample.
class Vote {
 public:
  struct Rules {
    double tolerance;
    std::int64_t confirm, comes_back;  ///< samples
  };
  struct Channel {
    std::int64_t against = 0;  ///< samples in a row outside, or inside while it is out
    bool out = false;
    bool missed = false;     ///< voted out because missing, not because different
    std::int64_t since = 0;  ///< sample at which the channel was voted out
  };
  explicit Vote(std::size_t channels, Rules rules) : rules_(rules), count_(channels) {}

  /// NaN: missing. Returns true when a channel was voted out or returned, or agreement was lost or
  /// regained.
  bool update(std::span<const double> values) noexcept;
  void reset() noexcept;
  [[nodiscard]] double value() const noexcept { return value_; }  ///< NaN: unknown
  [[nodiscard]] double spread() const noexcept { return spread_; }
  [[nodiscard]] bool disagree() const noexcept { return disagree_; }
  [[nodiscard]] const Channel& channel(std::size_t i) const noexcept { return channels_[i]; }
  /// Samples voted on so far.
  [[nodiscard]] std::int64_t votes() const noexcept { return votes_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }

 private:
  [[nodiscard]] bool judge(std::size_t i, bool wrong, bool missing) noexcept;

  Rules rules_;
  std::size_t count_;
  std::array<Channel, 3> channels_{};
  std::int64_t votes_ = 0;
  std::int64_t apart_ = 0;  ///< samples in a row that two channels differ
  bool disagree_ = false;
  double value_ = kNaN;
  double spread_ = kNaN;
};

}  // namespace estimator::fdi
