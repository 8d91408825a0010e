// Edges of the lines of a GPIO chip, with the kernel's time stamps.
#pragma once

#include <poll.h>

#include <array>
#include <memory>

#include "hal/encoder/edge_source.h"
#include "hal/encoder/gpio_chip.h"

namespace hal::encoder {

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
