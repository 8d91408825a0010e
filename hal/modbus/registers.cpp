#include "hal/modbus/registers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace hal::modbus {
namespace {

using config::schema::wiring;

constexpr std::int64_t kLastAddress = 65535;

std::uint16_t swapped(std::uint16_t word) noexcept {
  return static_cast<std::uint16_t>((word << 8U) | (word >> 8U));
}

}  // namespace

void Register::visit(config::schema::Visitor& v) {
  v.choice(wiring({"role", "role", true}), role,
           {"rod", "valve_command", "valve_readback", "input", "output", "watchdog"});
  v.integer(wiring({"address", "protocol address, from 0", true}), address, {0, kLastAddress});
  v.choice(wiring({"function", "table of the device"}), function,
           {"holding", "input", "coil", "discrete"});
  const bool bits = table() == RegisterTable::coil || table() == RegisterTable::discrete;
  if (type.empty()) type = bits ? "bit" : "uint16";
  if (bits) {
    v.choice(wiring({"type", "a bit"}), type, {"bit"});
  } else {
    v.choice(wiring({"type", "type of the raw value"}), type,
             {"int16", "uint16", "int32", "uint32", "float32"});
    v.choice(wiring({"order", "byte order, A the most significant"}), order,
             {"ABCD", "CDAB", "BADC", "DCBA"});
  }
  v.number(wiring({"scale", "SI unit per raw unit"}), scale, {-1e12, 1e12});
  v.number(wiring({"offset", "SI value at raw 0"}), offset, {-1e12, 1e12});
  v.number({"low", "lowest value, SI"}, low);
  v.number({"high", "highest value, SI"}, high);
}

RegisterTable Register::table() const noexcept {
  if (function == "input") return RegisterTable::input;
  if (function == "coil") return RegisterTable::coil;
  if (function == "discrete") return RegisterTable::discrete;
  return RegisterTable::holding;
}

int Register::words() const noexcept {
  return type == "int32" || type == "uint32" || type == "float32" ? 2 : 1;
}

bool Register::overlaps(const Register& other) const noexcept {
  return table() == other.table() && address < other.address + other.words() &&
         other.address < address + words();
}

Codec::Codec(const Register& r) noexcept
    : kind_(r.type == "float32" ? Kind::single : Kind::whole),
      wide_(r.words() == 2),
      signed_(r.type == "int16" || r.type == "int32"),
      swap_words_(r.order == "CDAB" || r.order == "DCBA"),
      swap_bytes_(r.order == "BADC" || r.order == "DCBA"),
      scale_(r.scale),
      offset_(r.offset),
      low_(r.low),
      high_(r.high) {
  const double span = std::ldexp(1.0, r.type == "bit" ? 1 : wide_ ? 32 : 16);
  raw_low_ = signed_ ? -span / 2.0 : 0.0;
  raw_high_ = raw_low_ + span - 1.0;
  if (kind_ == Kind::single) {
    raw_high_ = std::numeric_limits<float>::max();
    raw_low_ = -raw_high_;
  }
}

Bits Codec::encode(double value) const noexcept {
  const double in_range = std::clamp(value, low_, high_);
  const double raw = std::clamp((in_range - offset_) / scale_, raw_low_, raw_high_);
  if (kind_ == Kind::single) return std::bit_cast<Bits>(static_cast<float>(raw));
  const auto whole = static_cast<std::int64_t>(std::llround(raw));
  return static_cast<Bits>(whole) & (wide_ ? 0xFFFFFFFFU : 0xFFFFU);
}

double Codec::decode(Bits bits) const noexcept {
  double raw = static_cast<double>(bits);
  if (kind_ == Kind::single) {
    raw = static_cast<double>(std::bit_cast<float>(bits));
  } else if (signed_) {
    raw = wide_ ? static_cast<double>(static_cast<std::int32_t>(bits))
                : static_cast<double>(static_cast<std::int16_t>(bits));
  }
  return raw * scale_ + offset_;
}

void Codec::store(Bits bits, std::uint16_t* words) const noexcept {
  auto first = static_cast<std::uint16_t>(wide_ ? bits >> 16U : bits);
  auto second = static_cast<std::uint16_t>(bits);
  if (wide_ && swap_words_) std::swap(first, second);
  words[0] = swap_bytes_ ? swapped(first) : first;
  if (wide_) words[1] = swap_bytes_ ? swapped(second) : second;
}

Bits Codec::load(const std::uint16_t* words) const noexcept {
  std::uint16_t first = swap_bytes_ ? swapped(words[0]) : words[0];
  if (!wide_) return first;
  std::uint16_t second = swap_bytes_ ? swapped(words[1]) : words[1];
  if (swap_words_) std::swap(first, second);
  return static_cast<Bits>(first) << 16U | second;
}

double Codec::resolution() const noexcept {
  return kind_ == Kind::single ? 0.0 : 0.5 * std::abs(scale_);
}

}  // namespace hal::modbus
