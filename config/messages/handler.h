// The daemon's messages, one kind per type of spoolwatch.lcm, and the interface of what takes them.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace spoolwatch {
class sample_t;
class rods_t;
class pressures_t;
class estimate_t;
class alarm_t;
class health_t;
}  // namespace spoolwatch

namespace config::messages {

enum class MessageKind { sample, rods, pressures, estimate, alarm, health };
inline constexpr std::array kMessageKinds{MessageKind::sample,    MessageKind::rods,
                                          MessageKind::pressures, MessageKind::estimate,
                                          MessageKind::alarm,     MessageKind::health};

/// "sample"
[[nodiscard]] const char* to_string(MessageKind kind) noexcept;
/// "_SAMPLE": the channel of a kind is its prefix and this.
[[nodiscard]] std::string_view channel_ending(MessageKind kind) noexcept;
/// Null where the channel is none of this prefix.
[[nodiscard]] std::optional<MessageKind> kind_of(std::string_view channel,
                                                 std::string_view prefix) noexcept;

class MessageHandler {
 public:
  virtual ~MessageHandler() = default;
  virtual void on(const spoolwatch::sample_t& /*sample*/) {}
  /// Rods and pressures come just before the sample that they belong to.
  virtual void on(const spoolwatch::rods_t& /*rods*/) {}
  virtual void on(const spoolwatch::pressures_t& /*pressures*/) {}
  virtual void on(const spoolwatch::estimate_t& /*estimate*/) {}
  virtual void on(const spoolwatch::alarm_t& /*alarm*/) {}
  virtual void on(const spoolwatch::health_t& /*health*/) {}
};

}  // namespace config::messages
