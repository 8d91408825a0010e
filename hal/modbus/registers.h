// One entry of a register map: where a quantity stands in a Modbus device, how its bits are laid
// out, and how they become SI units.
//
//   value = raw * scale + offset      (metres, volts, pascals, seconds; 0 and 1 of a switch)
//
// raw: two's complement, unsigned or IEEE 754, of 16 or 32 bits. With A the most significant byte,
// `order` says how a device sends the four bytes of two registers: ABCD, CDAB (words swapped), BADC
// (bytes of each word swapped), DCBA. Of one register BADC and DCBA swap the two bytes.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "config/schema/visitor.h"

namespace hal::modbus {

/// The four tables of a Modbus device.
enum class RegisterTable : std::uint8_t { holding, input, coil, discrete };

/// The raw bits of a value, least significant at the right, whatever the order on the wire.
using Bits = std::uint32_t;

/// TOML [modbus.registers.NAME].
struct Register {
  std::string name;  ///< the channel by which roles name it
  std::string role = "input";
  std::int64_t address = 0;  ///< as in the protocol, from 0
  std::string function = "holding";
  std::string type;  ///< empty until read: uint16, or bit where the table holds bits
  std::string order = "ABCD";
  double scale = 1.0;
  double offset = 0.0;
  double low = -std::numeric_limits<double>::infinity();  ///< SI; beyond it a reading is bad and
  double high = std::numeric_limits<double>::infinity();  ///< a command is clamped

  void visit(config::schema::Visitor& v);

  [[nodiscard]] RegisterTable table() const noexcept;
  /// Registers that it takes, 1 or 2.
  [[nodiscard]] int words() const noexcept;
  [[nodiscard]] bool overlaps(const Register& other) const noexcept;
};

/// Between SI and registers. Small and without texts, so that the loop may use it.
class Codec {
 public:
  Codec() = default;
  explicit Codec(const Register& r) noexcept;

  /// Nearest raw value within low, high and the type's range. `value` is a number.
  [[nodiscard]] Bits encode(double value) const noexcept;
  [[nodiscard]] double decode(Bits bits) const noexcept;
  [[nodiscard]] int words() const noexcept { return wide_ ? 2 : 1; }
  /// Writes words() registers as they go over the wire.
  void store(Bits bits, std::uint16_t* words) const noexcept;
  [[nodiscard]] Bits load(const std::uint16_t* words) const noexcept;
  /// A finite value within low and high.
  [[nodiscard]] bool plausible(double value) const noexcept {
    return value >= low_ && value <= high_ && value - value == 0.0;
  }
  /// Greatest distance between a value in range and the nearest raw one.
  [[nodiscard]] double resolution() const noexcept;

 private:
  enum class Kind : std::uint8_t { whole, single };

  Kind kind_ = Kind::whole;
  bool wide_ = false;
  bool signed_ = false;
  bool swap_words_ = false;
  bool swap_bytes_ = false;
  double raw_low_ = 0.0;
  double raw_high_ = 65535.0;
  double scale_ = 1.0;
  double offset_ = 0.0;
  double low_ = 0.0;
  double high_ = 0.0;
};

}  // namespace hal::modbus
