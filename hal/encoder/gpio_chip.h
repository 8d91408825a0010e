// RAII over libgpiod: a GPIO chip and its lines requested by this process. Errors name the place in
// the configuration.
#pragma once

#include <gpiod.h>
#include <poll.h>
#include <array>
#include <memory>
#include <string>

#include "hal/encoder/edge_source.h"

namespace hal::encoder {

/// Named in error messages.
inline constexpr const char* kConsumer = "spoolwatch";

/// `claim`: the line as it is; neither its direction nor its level changes.
enum class Use : std::uint8_t { edges, input, output, claim };

/// Wiring of a line. `bias`: as_is, pull_up, pull_down, disabled.
struct Wiring {
  bool active_low = false;
  std::string bias = "as_is";
};

class GpioChip;

/// One requested line; released by the destructor.
class GpioLine {
 public:
  GpioLine(std::shared_ptr<GpioChip> chip, gpiod_line* line) noexcept
      : chip_(std::move(chip)), line_(line) {}
  ~GpioLine() { gpiod_line_release(line_); }
  GpioLine(const GpioLine&) = delete;
  GpioLine& operator=(const GpioLine&) = delete;

  /// 0, 1, or -1 when the line cannot be read.
  [[nodiscard]] int value() const noexcept { return gpiod_line_get_value(line_); }
  /// False when the line cannot be set.
  bool set(bool on) const noexcept { return gpiod_line_set_value(line_, on ? 1 : 0) == 0; }
  /// Readable while there are edges.
  [[nodiscard]] int fd() const noexcept { return gpiod_line_event_get_fd(line_); }

 private:
  std::shared_ptr<GpioChip> chip_;
  gpiod_line* line_;
};

class GpioChip : public std::enable_shared_from_this<GpioChip> {
 public:
  /// By path, name or label. Throws config::schema::Error; `where`: "file: [encoder] chip".
  static std::shared_ptr<GpioChip> open(const std::string& where, const std::string& description);
  ~GpioChip() { gpiod_chip_close(chip_); }
  GpioChip(const GpioChip&) = delete;
  GpioChip& operator=(const GpioChip&) = delete;

  /// An output starts at 0. Throws config::schema::Error: no such line, or in use.
  std::shared_ptr<GpioLine> request(const std::string& where, std::int64_t offset, Use use,
                                    const Wiring& wiring);

 private:
  explicit GpioChip(gpiod_chip* chip) noexcept : chip_(chip) {}

  gpiod_chip* chip_;
};

/// Edges of the lines of a GPIO chip, with the kernel's time stamps.
class GpioSource final : public EdgeSource {
 public:
  /// Lines requested for edges; `index` may be null.
  GpioSource(std::shared_ptr<GpioLine> a, std::shared_ptr<GpioLine> b,
             std::shared_ptr<GpioLine> index);

  /// After a failure returns only when the time is over.
  Wake wait(std::int64_t timeout_ns) noexcept override;
  Drained drain(std::span<Edge, kBatch> into) noexcept override;
  std::optional<Levels> levels() noexcept override;

 private:
  std::array<std::shared_ptr<GpioLine>, 3> lines_;  ///< in the order of Line
  std::array<pollfd, 3> polled_{};
  nfds_t count_;
};

}  // namespace hal::encoder
