// Data acquisition board as needed by this backend: codes to and from channels. Implemented over
// comedilib, and by a test double.
#pragma once

#include <comedilib.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hal/comedi/scale.h"

namespace hal::comedi {

enum class ChannelKind : std::uint8_t { analog_input, analog_output, counter };

/// One channel, as configured. `subdevice` -1: the first of its kind.
struct ChannelConfig {
  std::int64_t subdevice = -1;
  std::int64_t channel = 0;
  std::int64_t range = 0;
  std::string aref = "ground";  ///< ground, common, diff, other
};

/// A channel verified to exist.
struct BoardChannel {
  unsigned subdevice = 0;
  unsigned channel = 0;
  unsigned range = 0;
  unsigned aref = 0;
};

class Board {
 public:
  virtual ~Board() = default;
  /// May block as long as the driver does. Any thread; async-signal-safe.
  virtual bool write(const BoardChannel& place, std::uint32_t code) noexcept = 0;
  virtual std::optional<std::uint32_t> read(const BoardChannel& place) noexcept = 0;
};

class ComediBoard final : public Board {
 public:
  /// Throws config::schema::DeviceUnavailable; `where`: "file: [comedi] device".
  ComediBoard(const std::string& where, const std::string& device);

  /// Throws config::schema::ConfigError when the board has no such channel; `table`: "file:
  /// [comedi.rod]".
  [[nodiscard]] BoardChannel find(const std::string& table, ChannelKind kind,
                                  const ChannelConfig& channel) const;
  /// Voltage range of the channel.
  [[nodiscard]] ConverterSpan span(const std::string& table, const BoardChannel& place) const;
  /// Locks the subdevice against other programs until this one ends. Throws
  /// config::schema::ConfigError.
  void lock(const std::string& table, const BoardChannel& place) const;
  /// Largest code of the channel.
  [[nodiscard]] std::uint32_t max_code(const BoardChannel& place) const;

  bool write(const BoardChannel& place, std::uint32_t code) noexcept override;
  std::optional<std::uint32_t> read(const BoardChannel& place) noexcept override;

 private:
  struct Close {
    void operator()(comedi_t* board) const noexcept { comedi_close(board); }
  };
  std::unique_ptr<comedi_t, Close> board_;
};

}  // namespace hal::comedi
