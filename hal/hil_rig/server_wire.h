// Parsing of requests and addresses outside libmodbus.
#pragma once

#include <arpa/inet.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace hal::hil_rig {

struct HostPort {
  std::string host;
  int port = 0;
};

/// Splits "127.0.0.1:1502"; empty for any other form.
inline std::optional<HostPort> split_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return std::nullopt;
  HostPort place{text.substr(0, colon), 0};
  const std::string digits = text.substr(colon + 1);
  in_addr ignored{};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (inet_pton(AF_INET, place.host.c_str(), &ignored) != 1 || digits.empty() ||
      digits.size() > 5 || !std::all_of(digits.begin(), digits.end(), is_digit)) {
    return std::nullopt;
  }
  place.port = std::stoi(digits);
  if (place.port > 65535) return std::nullopt;
  return place;
}

/// The part of a request that begins with the function code.
class ModbusRequest {
 public:
  struct Range {
    int address = 0;
    int count = 0;
  };

  explicit ModbusRequest(const std::uint8_t* pdu) noexcept : pdu_(pdu) {}

  [[nodiscard]] int address() const noexcept { return word(1); }
  [[nodiscard]] bool of_coils() const noexcept { return pdu_[0] == 5 || pdu_[0] == 15; }
  /// The values to write, if any.
  [[nodiscard]] std::optional<Range> written() const noexcept {
    switch (pdu_[0]) {
      case 5:
      case 6:
      case 22:
        return Range{word(1), 1};
      case 15:
      case 16:
        return Range{word(1), word(3)};
      case 23:
        return Range{word(5), word(7)};
      default:
        return std::nullopt;
    }
  }

 private:
  [[nodiscard]] int word(int at) const noexcept { return pdu_[at] << 8U | pdu_[at + 1]; }

  const std::uint8_t* pdu_;
};

/// Two characters per register, the first high; the rest 0.
inline void put_text(const std::string& text, std::uint16_t* registers, int count) {
  for (int i = 0; i < count; ++i) {
    const auto character = [&](int at) {
      return static_cast<std::size_t>(at) < text.size()
                 ? static_cast<unsigned>(static_cast<unsigned char>(text[at]))
                 : 0U;
    };
    registers[i] = static_cast<std::uint16_t>(character(2 * i) << 8U | character(2 * i + 1));
  }
}

inline std::string text_of(const std::uint16_t* registers, int count) {
  std::string text;
  for (int i = 0; i < 2 * count; ++i) {
    const auto character =
        static_cast<char>(i % 2 == 0 ? registers[i / 2] >> 8U : registers[i / 2]);
    if (character == '\0') break;
    text.push_back(character);
  }
  return text;
}

}  // namespace hal::hil_rig
