// The device's answer to a request, from the function code on.
#include <ctime>

#include "tests/hal/modbus/device.h"

namespace hal::modbus {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::int64_t clock_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1'000'000'000LL + t.tv_nsec;
}

int word(const Bytes& b, std::size_t at) { return b.at(at) << 8 | b.at(at + 1); }

void push(Bytes& b, int value) {
  b.push_back(static_cast<std::uint8_t>(value >> 8));
  b.push_back(static_cast<std::uint8_t>(value));
}

}  // namespace

Bytes Device::carry_out(const Bytes& q, int connection) {
  const std::lock_guard lock(mutex_);
  const int function = q[0];
  Received received{clock_ns(), connection, function, word(q, 1), {}};
  const auto refuse = [&](int code) {
    received_.push_back(received);
    return Bytes{static_cast<std::uint8_t>(function | 0x80), static_cast<std::uint8_t>(code)};
  };
  const auto inside = [&](int address, int count) {
    return address + count <= static_cast<int>(registers_.size());
  };
  const auto store = [&](int address, std::size_t from, int count) {
    for (int i = 0; i < count; ++i) {
      const auto value = static_cast<std::uint16_t>(word(q, from + 2U * static_cast<unsigned>(i)));
      registers_[static_cast<std::size_t>(address + i)] = value;
      received.words.push_back(value);
    }
  };
  const auto fetch = [&](int address, int count) {
    Bytes pdu{q[0], static_cast<std::uint8_t>(2 * count)};
    for (int i = 0; i < count; ++i) push(pdu, registers_[static_cast<std::size_t>(address + i)]);
    return pdu;
  };
  if (function == 3 || function == 4) {
    if (!inside(word(q, 1), word(q, 3))) return refuse(2);
    received_.push_back(received);
    return fetch(word(q, 1), word(q, 3));
  }
  if (function == 6 || function == 16) {
    const int count = function == 6 ? 1 : word(q, 3);
    if (!inside(word(q, 1), count)) return refuse(2);
    store(word(q, 1), function == 6 ? 3 : 6, count);
    received_.push_back(received);
    return Bytes(q.begin(), q.begin() + 5);
  }
  if (function == 23) {
    received.address = word(q, 5);
    if (!inside(word(q, 1), word(q, 3)) || !inside(word(q, 5), word(q, 7))) return refuse(2);
    store(word(q, 5), 10, word(q, 7));
    received_.push_back(received);
    return fetch(word(q, 1), word(q, 3));
  }
  return refuse(1);
}

}  // namespace hal::modbus
