#include "config/messages/handler.h"

namespace config::messages {
namespace {

constexpr std::array kNames{"sample", "rods", "pressures", "estimate", "alarm", "health"};
constexpr std::array<std::string_view, kMessageKinds.size()> kEndings{
    "_SAMPLE", "_RODS", "_PRESSURES", "_ESTIMATE", "_ALARM", "_HEALTH"};

}  // namespace

const char* to_string(MessageKind kind) noexcept { return kNames[static_cast<std::size_t>(kind)]; }

std::string_view channel_ending(MessageKind kind) noexcept {
  return kEndings[static_cast<std::size_t>(kind)];
}

std::optional<MessageKind> kind_of(std::string_view channel, std::string_view prefix) noexcept {
  if (!channel.starts_with(prefix)) return {};
  channel.remove_prefix(prefix.size());
  for (const MessageKind kind : kMessageKinds) {
    if (channel == channel_ending(kind)) return kind;
  }
  return {};
}

}  // namespace config::messages
