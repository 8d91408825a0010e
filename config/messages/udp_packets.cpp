#include "config/messages/udp_packets.h"

#include <algorithm>

namespace config::messages {
namespace {

constexpr std::uint32_t kShortMagic = 0x4c433032;
constexpr std::uint32_t kFragmentMagic = 0x4c433033;
constexpr std::size_t kShortHeader = 8;
constexpr std::size_t kFragmentHeader = 20;

std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) {
    value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
  }
  return value;
}

/// Takes the channel off the front; empty where there is none.
std::string take_channel(std::string_view& bytes) {
  const std::size_t end = bytes.substr(0, PacketReassembler::kMostChannel + 1).find('\0');
  if (end == std::string_view::npos) return "";
  const std::string channel(bytes.substr(0, end));
  bytes.remove_prefix(end + 1);
  return channel;
}

}  // namespace

std::optional<ReceivedMessage> PacketReassembler::refuse() {
  ++refused_;
  return {};
}

std::optional<ReceivedMessage> PacketReassembler::add(std::uint64_t sender,
                                                      std::string_view packet) {
  if (packet.size() < kShortHeader) return refuse();
  const std::uint32_t magic = number_at(packet, 0, 4);
  if (magic == kFragmentMagic) return add_fragment(sender, packet);
  if (magic != kShortMagic) return refuse();
  packet.remove_prefix(kShortHeader);
  const std::string channel = take_channel(packet);
  if (channel.empty()) return refuse();
  return ReceivedMessage{channel, std::string(packet)};
}

std::optional<ReceivedMessage> PacketReassembler::add_fragment(std::uint64_t sender,
                                                               std::string_view packet) {
  if (packet.size() < kFragmentHeader) return refuse();
  const std::uint32_t number = number_at(packet, 4, 4);
  const std::size_t size = number_at(packet, 8, 4);
  const std::size_t offset = number_at(packet, 12, 4);
  const std::size_t index = number_at(packet, 16, 2);
  const std::size_t count = number_at(packet, 18, 2);
  packet.remove_prefix(kFragmentHeader);
  std::string channel;
  if (index == 0) {
    channel = take_channel(packet);
    if (channel.empty()) return refuse();
  }
  if (size == 0 || size > kMostBytes || index >= count || count > size || offset > size ||
      packet.size() > size - offset) {
    return refuse();
  }
  auto found = std::find_if(unfinished_.begin(), unfinished_.end(), [&](const Unfinished& u) {
    return u.sender == sender && u.number == number;
  });
  if (found != unfinished_.end() &&
      (found->message.payload.size() != size || found->has.size() != count)) {
    unfinished_.erase(found);
    return refuse();
  }
  if (found == unfinished_.end()) {
    if (unfinished_.size() >= kMostUnfinished) unfinished_.pop_front();
    found = unfinished_.insert(
        unfinished_.end(),
        {sender, number, size, std::vector<bool>(count), {"", std::string(size, '\0')}});
  }
  if (found->has[index] || packet.size() > found->left) {
    unfinished_.erase(found);
    return refuse();
  }
  found->has[index] = true;
  found->left -= packet.size();
  packet.copy(found->message.payload.data() + offset, packet.size());
  if (index == 0) found->message.channel = channel;
  if (found->left > 0 ||
      !std::all_of(found->has.begin(), found->has.end(), [](bool b) { return b; }))
    return {};
  ReceivedMessage whole = std::move(found->message);
  unfinished_.erase(found);
  return whole;
}

}  // namespace config::messages
