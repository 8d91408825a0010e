// Requests and replies of the Modbus application protocol, and the check of a reply against its
// request: function, length, echoed address and value, exception.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hal/modbus/register_map.h"

namespace hal::modbus {

/// From the function code on; 253 bytes at most. Without allocation.
class Pdu {
 public:
  static constexpr std::size_t kMost = 253;

  void push(unsigned byte) noexcept { bytes_[size_++] = static_cast<std::uint8_t>(byte); }
  void push_word(unsigned word) noexcept {
    push(word >> 8U);
    push(word);
  }
  /// `size` is at most kMost.
  void resize(std::size_t size) noexcept { size_ = size; }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] std::uint8_t* data() noexcept { return bytes_.data(); }
  [[nodiscard]] const std::uint8_t* data() const noexcept { return bytes_.data(); }
  [[nodiscard]] unsigned operator[](std::size_t i) const noexcept { return bytes_[i]; }
  [[nodiscard]] unsigned word(std::size_t i) const noexcept {
    return static_cast<unsigned>(bytes_[i]) << 8U | bytes_[i + 1];
  }

 private:
  std::array<std::uint8_t, kMost> bytes_{};
  std::size_t size_ = 0;
};

[[nodiscard]] Pdu read_request(const Block& block) noexcept;
/// Function 5, 6 or 16; `multiple_only`: 16 for a single register too.
[[nodiscard]] Pdu write_request(const WriteChannel& channel, Bits bits,
                                bool multiple_only) noexcept;
/// Function 23: writes, then reads.
[[nodiscard]] Pdu exchange_request(const WriteChannel& channel, Bits bits,
                                   const Block& block) noexcept;

/// Length of the reply to that request when the device carries it out.
[[nodiscard]] std::size_t reply_size(const Pdu& request) noexcept;
/// 0, or an errno of libmodbus: the exception that the device raised (EMBXILFUN to EMBXGTAR), or
/// EMBBADDATA or EMBBADEXC for a reply that does not answer this request.
[[nodiscard]] int check_reply(const Pdu& request, const Pdu& reply) noexcept;
/// One word per register; for bits, 0 or 1. The reply has been checked.
void unpack(const Block& block, const Pdu& reply, std::uint16_t* words) noexcept;

}  // namespace hal::modbus
