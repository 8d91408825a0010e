// Checked register map and its grouping into read requests: adjacent registers of one table are
// read at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hal/modbus/registers.h"

namespace hal::modbus {

/// Protocol limits of one request.
inline constexpr int kMostRegisters = 125;
inline constexpr int kMostBits = 2000;

/// Registers read by one request.
struct Block {
  RegisterTable table = RegisterTable::holding;
  int address = 0;
  int count = 0;
};

/// A value read every period.
struct ReadChannel {
  std::string name;
  std::string role;
  Codec codec;
  std::size_t block = 0;
  int at = 0;  ///< first register within the block
};

/// A value written on demand.
struct WriteChannel {
  std::string name;
  RegisterTable table = RegisterTable::holding;
  int address = 0;
  Codec codec;
};

struct RegisterMap {
  std::vector<Block> blocks;  ///< with function 23 the first is read along with the write
  std::vector<ReadChannel> reads;
  std::optional<WriteChannel> valve;
  std::vector<WriteChannel> outputs;
  std::optional<WriteChannel> watchdog;

  /// Index in `reads` of the channel with that role, or none.
  [[nodiscard]] std::optional<std::size_t> find_role(const std::string& role) const;
};

/// Checks the map: limits in order, nothing past the last address, no two in one place (but a
/// read-back of the command), each unique role at most once. `where` is the file, for messages.
/// Throws config::schema::ConfigError.
[[nodiscard]] RegisterMap make_register_map(const std::string& where,
                                            const std::vector<Register>& registers, bool combined);

}  // namespace hal::modbus
