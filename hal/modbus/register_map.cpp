#include "hal/modbus/register_map.h"

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"

namespace hal::modbus {
namespace {

using config::schema::bad_config;

constexpr std::int64_t kAddresses = 65536;
constexpr std::size_t kMostChannels = 64;
constexpr std::size_t kMostBlocks = 16;

bool is_bits(RegisterTable table) {
  return table == RegisterTable::coil || table == RegisterTable::discrete;
}
bool is_read(const Register& r) {
  return r.role == "rod" || r.role == "valve_readback" || r.role == "input";
}

std::string place(const std::string& where, const Register& r, const char* key) {
  return where + ": [modbus.registers." + r.name + "] " + key;
}

/// Requirements of a role on its register.
void check_role(const std::string& where, const Register& r) {
  const bool whole_or_float = r.role == "valve_command" || r.role == "watchdog";
  if (whole_or_float && r.table() != RegisterTable::holding) {
    throw bad_config(place(where, r, "function"),
                     "is \"" + r.function + "\", and a " + r.role + " is written", "holding");
  }
  if (r.role == "output" && r.table() != RegisterTable::coil &&
      r.table() != RegisterTable::holding) {
    throw bad_config(place(where, r, "function"),
                     "is \"" + r.function + "\", and an output is written", "coil, holding");
  }
}

void check_alone(const std::string& where, const Register& r) {
  if (r.address + r.words() > kAddresses) {
    throw bad_config(place(where, r, "address"),
                     "is " + std::to_string(r.address) + ", and a " + r.type + " there ends past " +
                         std::to_string(kAddresses - 1),
                     "0 to " + std::to_string(kAddresses - r.words()));
  }
  if (!(r.low < r.high)) {
    throw bad_config(place(where, r, "low"), "is not below high", "low < high");
  }
  if (r.scale == 0.0 || !std::isfinite(r.scale)) {
    throw bad_config(place(where, r, "scale"), "is 0", "any other number");
  }
  check_role(where, r);
}

bool reads_back(const Register& a, const Register& b) {
  return a.role == "valve_command" && b.role == "valve_readback" && a.address == b.address &&
         a.words() == b.words();
}

void check_pairs(const std::string& where, const std::vector<Register>& registers) {
  for (std::size_t i = 0; i < registers.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Register& a = registers[i];
      const Register& b = registers[j];
      if (a.overlaps(b) && !reads_back(a, b) && !reads_back(b, a)) {
        throw bad_config(place(where, a, "address"),
                         "is " + std::to_string(a.address) + ", which overlaps [modbus.registers." +
                             b.name + "] at " + std::to_string(b.address),
                         "each register in one entry");
      }
      const bool one_only =
          a.role == "valve_command" || a.role == "valve_readback" || a.role == "watchdog";
      if (one_only && a.role == b.role) {
        throw bad_config(place(where, a, "role"),
                         "is \"" + a.role + "\", as of [modbus.registers." + b.name + "]",
                         "one of each");
      }
    }
  }
}

/// Puts a register into a block that it continues, or into a new one. Registers come sorted.
void add_read(RegisterMap& map, const Register& r) {
  const int most = is_bits(r.table()) ? kMostBits : kMostRegisters;
  const int address = static_cast<int>(r.address);
  const auto fits = [&](const Block& b) {
    return b.table == r.table() && b.address + b.count == address && b.count + r.words() <= most;
  };
  auto block = std::find_if(map.blocks.begin(), map.blocks.end(), fits);
  if (block == map.blocks.end()) {
    block = map.blocks.insert(block, Block{r.table(), address, 0});
  }
  const auto index = static_cast<std::size_t>(block - map.blocks.begin());
  map.reads.push_back({r.name, r.role, Codec(r), index, block->count});
  block->count += r.words();
}

}  // namespace

std::optional<std::size_t> RegisterMap::find_role(const std::string& role) const {
  for (std::size_t i = 0; i < reads.size(); ++i) {
    if (reads[i].role == role) return i;
  }
  return std::nullopt;
}

RegisterMap make_register_map(const std::string& where, const std::vector<Register>& registers,
                              bool combined) {
  for (const Register& r : registers) check_alone(where, r);
  check_pairs(where, registers);

  // Holding registers first: function 23 reads those, beginning with the rod's.
  std::vector<Register> sorted = registers;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Register& a, const Register& b) {
    return std::pair(a.table(), a.address) < std::pair(b.table(), b.address);
  });
  RegisterMap map;
  for (const Register& r : sorted) {
    const WriteChannel written{r.name, r.table(), static_cast<int>(r.address), Codec(r)};
    if (is_read(r)) add_read(map, r);
    if (r.role == "valve_command") map.valve = written;
    if (r.role == "watchdog") map.watchdog = written;
    if (r.role == "output") map.outputs.push_back(written);
  }
  if (map.reads.size() > kMostChannels || map.blocks.size() > kMostBlocks) {
    throw bad_config(
        where + ": [modbus.registers]",
        "has " + std::to_string(map.reads.size()) + " values to read in " +
            std::to_string(map.blocks.size()) + " requests",
        std::to_string(kMostChannels) + " values in " + std::to_string(kMostBlocks) + " requests");
  }
  if (!combined) return map;
  const auto rod = map.find_role("rod");
  const std::size_t along = rod ? map.reads[*rod].block : 0;
  if (!map.valve || map.blocks.empty() || map.blocks[along].table != RegisterTable::holding) {
    throw bad_config(where + ": [modbus] combined",
                     "is true without a valve_command and a reading in holding registers", "false");
  }
  std::swap(map.blocks[0], map.blocks[along]);
  for (ReadChannel& r : map.reads) r.block = r.block == 0 ? along : r.block == along ? 0 : r.block;
  return map;
}

}  // namespace hal::modbus
