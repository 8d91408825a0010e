#include "hal/modbus/frame.h"

#include <modbus/modbus.h>

#include <algorithm>

namespace hal::modbus {
namespace {

constexpr unsigned kException = 0x80;
constexpr unsigned kLastException = 11;

bool holds_bits(RegisterTable table) noexcept {
  return table == RegisterTable::coil || table == RegisterTable::discrete;
}

unsigned read_function(RegisterTable table) noexcept {
  switch (table) {
    case RegisterTable::coil:
      return 1;
    case RegisterTable::discrete:
      return 2;
    case RegisterTable::holding:
      return 3;
    case RegisterTable::input:
      break;
  }
  return 4;
}

}  // namespace

Pdu read_request(const Block& block) noexcept {
  Pdu pdu;
  pdu.push(read_function(block.table));
  pdu.push_word(static_cast<unsigned>(block.address));
  pdu.push_word(static_cast<unsigned>(block.count));
  return pdu;
}

Pdu write_request(const WriteChannel& channel, Bits bits, bool multiple_only) noexcept {
  Pdu pdu;
  if (channel.table == RegisterTable::coil) {
    pdu.push(5);
    pdu.push_word(static_cast<unsigned>(channel.address));
    pdu.push_word(bits != 0 ? 0xFF00 : 0);
    return pdu;
  }
  std::uint16_t words[2];
  channel.codec.store(bits, words);
  const auto count = static_cast<unsigned>(channel.codec.words());
  const bool single = count == 1 && !multiple_only;
  pdu.push(single ? 6 : 16);
  pdu.push_word(static_cast<unsigned>(channel.address));
  if (!single) {
    pdu.push_word(count);
    pdu.push(2 * count);
  }
  for (unsigned i = 0; i < count; ++i) pdu.push_word(words[i]);
  return pdu;
}

Pdu exchange_request(const WriteChannel& channel, Bits bits, const Block& block) noexcept {
  std::uint16_t words[2];
  channel.codec.store(bits, words);
  const auto count = static_cast<unsigned>(channel.codec.words());
  Pdu pdu;
  pdu.push(23);
  pdu.push_word(static_cast<unsigned>(block.address));
  pdu.push_word(static_cast<unsigned>(block.count));
  pdu.push_word(static_cast<unsigned>(channel.address));
  pdu.push_word(count);
  pdu.push(2 * count);
  for (unsigned i = 0; i < count; ++i) pdu.push_word(words[i]);
  return pdu;
}

std::size_t reply_size(const Pdu& request) noexcept {
  switch (request[0]) {
    case 1:
    case 2:
      return 2 + (request.word(3) + 7) / 8;
    case 3:
    case 4:
    case 23:
      return 2 + 2 * std::size_t{request.word(3)};
    default:
      return 5;
  }
}

int check_reply(const Pdu& request, const Pdu& reply) noexcept {
  if (reply.size() == 2 && reply[0] == (request[0] | kException)) {
    return reply[1] >= 1 && reply[1] <= kLastException ? MODBUS_ENOBASE + static_cast<int>(reply[1])
                                                       : EMBBADEXC;
  }
  if (reply[0] != request[0] || reply.size() != reply_size(request)) return EMBBADDATA;
  switch (request[0]) {
    case 5:
    case 6:
    case 16:  // address and value, or address and number of registers
      return std::equal(reply.data(), reply.data() + 5, request.data()) ? 0 : EMBBADDATA;
    default:
      return reply[1] == reply.size() - 2 ? 0 : EMBBADDATA;
  }
}

void unpack(const Block& block, const Pdu& reply, std::uint16_t* words) noexcept {
  const auto count = static_cast<std::size_t>(block.count);
  for (std::size_t i = 0; i < count; ++i) {
    words[i] = static_cast<std::uint16_t>(holds_bits(block.table) ? reply[2 + i / 8] >> (i % 8) & 1U
                                                                  : reply.word(2 + 2 * i));
  }
}

}  // namespace hal::modbus
