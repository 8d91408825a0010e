// LCM's UDP packets, reassembled to messages. Any datagram may come: nothing that a packet states
// is trusted, and memory is bounded. (liblcm 1.3 checks a fragment's offset with a sum that
// overflows, and writes outside its buffer.)
//
//   short     "LC02", number of the message, channel, 0, payload
//   fragment  "LC03", number of the message, bytes of the payload, offset of this fragment, number
//   of
//             this fragment (16 bits), number of fragments (16 bits); fragment 0: channel, 0;
//             payload
//
// Numbers are unsigned, of 32 bits where nothing else is said, most significant byte first.
#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace config::messages {

struct ReceivedMessage {
  std::string channel;
  std::string payload;
};

class PacketReassembler {
 public:
  static constexpr std::size_t kMostBytes = 1 << 20;  ///< a message may have
  static constexpr std::size_t kMostUnfinished = 8;   ///< messages; the oldest makes room
  static constexpr std::size_t kMostChannel = 63;     ///< LCM's own limit

  /// The message that this packet completes. `sender` tells the senders apart.
  std::optional<ReceivedMessage> add(std::uint64_t sender, std::string_view packet);
  /// Packets that were no part of a message.
  [[nodiscard]] std::int64_t refused() const noexcept { return refused_; }

 private:
  struct Unfinished {
    std::uint64_t sender;
    std::uint32_t number;
    std::size_t left;       ///< bytes that have not come
    std::vector<bool> has;  ///< by fragment
    ReceivedMessage message;
  };

  std::optional<ReceivedMessage> refuse();
  std::optional<ReceivedMessage> add_fragment(std::uint64_t sender, std::string_view packet);

  std::list<Unfinished> unfinished_;  ///< the oldest first
  std::int64_t refused_ = 0;
};

}  // namespace config::messages
