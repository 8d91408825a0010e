#include "estimator/fdi/voter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "config/schema/error.h"
#include "estimator/fdi/detection_method.h"

namespace estimator::fdi {
namespace {

using config::schema::bad_config;

class Voter final : public DetectionMethod {
 public:
  Voter(const VoterConfig& config, const MethodContext& context)
      : config_(config),
        sample_time_s_(context.sample_time_s),
        stride_(std::max<std::int64_t>(1, std::llround(config.stride_s / sample_time_s_))),
        vote_(config.channels.size(),
              {config.tolerance,
               std::max<std::int64_t>(1, std::llround(config.confirm_s / sample_time_s_)),
               std::max<std::int64_t>(1, std::llround(config.return_s / sample_time_s_))}) {
    for (const std::string& channel : config.channels) {
      inputs_.push_back(context.inputs.find(channel, "[[voter]] " + config.id));
    }
  }
  [[nodiscard]] std::vector<std::string> names() const override {
    return {"value", "spread", "out"};
  }
  [[nodiscard]] std::vector<Alarm> declared_alarms() const override {
    return {config_.naming.alarm("channel_out")};
  }
  bool on_gap(std::int64_t periods) noexcept override {
    samples_ += periods;
    return false;
  }
  bool push(const config::signals::Sample& /*sample*/, double /*y_m*/) noexcept override {
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      values[i] = inputs_[i].usable() ? inputs_[i].value() : kNaN;
    }
    const bool changed = vote_.update(std::span(values).first(inputs_.size()));
    if (++samples_ < stride_ && !changed) return false;
    samples_ = 0;
    return true;
  }
  MethodOutput evaluate(std::span<EstimatedValue> values) noexcept override {
    MethodOutput found;
    found.valid = !std::isnan(vote_.value());
    found.reason = found.valid ? "" : "the channels disagree or are missing";
    values[0].value = vote_.value();
    values[1].value = vote_.spread();
    values[2].value = vote_.disagree() ? -1.0 : static_cast<double>(first_out() + 1);
    return found;
  }
  [[nodiscard]] AlarmInput alarm_input(std::size_t /*number*/) const noexcept override;
  void reset() override {
    vote_.reset();
    samples_ = 0;
  }
  void serialize(StateArchive& archive) override {
    archive.value(vote_);
    archive.value(samples_);
    if (vote_.count() != inputs_.size()) archive.fail();
  }
  [[nodiscard]] double interval_s() const noexcept override {
    return static_cast<double>(stride_) * sample_time_s_;
  }

 private:
  /// -1 when all are in.
  [[nodiscard]] int first_out() const noexcept {
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if (vote_.channel(i).out) return static_cast<int>(i);
    }
    return -1;
  }

  VoterConfig config_;
  double sample_time_s_;
  std::int64_t stride_;
  Vote vote_;
  std::vector<MethodInput> inputs_;
  std::int64_t samples_ = 0;
  mutable FaultName fault_;
  mutable std::array<std::string_view, 3> group_;
  mutable char reason_[200] = "";
};

AlarmInput Voter::alarm_input(std::size_t /*number*/) const noexcept {
  AlarmInput input;
  input.value = vote_.spread();
  const int out = first_out();
  fault_ = {};
  input.fault = &fault_;
  if (vote_.disagree()) {
    input.severity = Severity::invalid;
    std::size_t size = 0;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if (!vote_.channel(i).out) group_[size++] = config_.channels[i];
    }
    fault_.group = std::span<const std::string_view>(group_.data(), size);
    input.reason =
        size > 0 ? "two channels disagree; the wrong one is unknown" : "no channel is left";
    return input;
  }
  if (out < 0) {
    input.reason = "all channels agree";
    return input;
  }
  const auto number = static_cast<std::size_t>(out);
  input.severity = config_.naming.level();
  fault_.parameter = config_.channels[number];
  std::snprintf(reason_, sizeof reason_, "channel %s voted out %.3g s ago; the others continue",
                config_.channels[number].c_str(),
                static_cast<double>(vote_.votes() - vote_.channel(number).since) * sample_time_s_);
  input.reason = reason_;
  return input;
}

}  // namespace

bool Vote::judge(std::size_t i, bool wrong, bool missing) noexcept {
  Channel& channel = channels_[i];
  channel.against = wrong != channel.out ? channel.against + 1 : 0;
  if (channel.against < (channel.out ? rules_.comes_back : rules_.confirm)) return false;
  if (!channel.out) {
    channel.since = votes_ - channel.against + 1;
    channel.missed = missing;
  }
  channel.out = !channel.out;
  channel.against = 0;
  return true;
}

bool Vote::update(std::span<const double> values) noexcept {
  ++votes_;
  // Participating channels: in use and present. Where none is in use, the present ones are compared
  // with each other for their return.
  bool none_in = true;
  for (std::size_t i = 0; i < count_; ++i) none_in = none_in && channels_[i].out;
  std::array<double, 3> present{};  // in rising order
  std::size_t size = 0;
  for (std::size_t i = 0; i < count_ && i < present.size(); ++i) {
    if ((channels_[i].out && !none_in) || !std::isfinite(values[i])) continue;
    std::size_t at = size++;
    for (; at > 0 && present[at - 1] > values[i]; --at) present[at] = present[at - 1];
    present[at] = values[i];
  }
  spread_ = size > 0 ? present[size - 1] - present[0] : kNaN;
  const bool differ = size == 2 && spread_ > rules_.tolerance;
  const bool apart = differ && !none_in;
  apart_ = apart ? apart_ + 1 : 0;
  const bool was = disagree_;
  disagree_ = apart_ >= rules_.confirm || size == 0 || none_in;
  const double agreed = size == 3   ? present[1]
                        : size == 2 ? 0.5 * (present[0] + present[1])
                                    : present[0];
  value_ = disagree_ ? kNaN : agreed;
  if (none_in) spread_ = kNaN;
  bool changed = disagree_ != was;
  for (std::size_t i = 0; i < count_; ++i) {
    // Where two channels differ, neither is declared wrong; no channel returns while the wrong one
    // is unknown.
    const bool missing = !std::isfinite(values[i]);
    const bool tells = size > 1 ? !differ : channels_[i].missed;
    const bool compared = none_in ? tells : !disagree_ && (size != 2 || channels_[i].out);
    const bool wrong =
        missing || (compared ? std::abs(values[i] - agreed) > rules_.tolerance : channels_[i].out);
    changed = judge(i, wrong, missing) || changed;
  }
  return changed;
}

void Vote::reset() noexcept { *this = Vote(count_, rules_); }

void VoterConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "name; prefix of its values: ID.value", true}, id);
  v.texts({"channels", "two or three values of one quantity", true}, channels);
  v.number({"tolerance", "allowed difference of channels, in their unit", true}, tolerance,
           {0.0, 1e12});
  v.number({"confirm_s", "time of disagreement before a channel is voted out"}, confirm_s,
           {0.0, 3600.0});
  v.number({"return_s", "time of agreement before a channel returns"}, return_s, {0.0, 86400.0});
  v.number({"stride_s", "time between outputs"}, stride_s, {1e-4, 3600.0});
  naming.visit(v);
}

std::unique_ptr<DetectionMethod> VoterConfig::make(const MethodContext& context) const {
  if (channels.size() < 2 || channels.size() > 3) {
    throw bad_config("[[voter]] " + id + ": channels", std::to_string(channels.size()) + " given",
                     "two or three");
  }
  return std::make_unique<Voter>(*this, context);
}

}  // namespace estimator::fdi
