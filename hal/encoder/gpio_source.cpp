#include "hal/encoder/gpio_source.h"

#include <time.h>

#include <cerrno>
#include <utility>

namespace hal::encoder {

GpioSource::GpioSource(std::shared_ptr<GpioLine> a, std::shared_ptr<GpioLine> b,
                       std::shared_ptr<GpioLine> index)
    : lines_{std::move(a), std::move(b), std::move(index)}, count_(lines_[2] == nullptr ? 2 : 3) {
  for (nfds_t i = 0; i < count_; ++i) polled_[i] = {lines_[i]->fd(), POLLIN, 0};
}

Wake GpioSource::wait(std::int64_t timeout_ns) noexcept {
  const timespec timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
  const int ready = ppoll(polled_.data(), count_, &timeout, nullptr);
  bool failed = ready < 0 && errno != EINTR;
  for (nfds_t i = 0; i < count_; ++i) {
    failed = failed || (ready > 0 && (polled_[i].revents & (POLLERR | POLLHUP | POLLNVAL)) != 0);
  }
  if (failed) {
    nanosleep(&timeout, nullptr);
    return Wake::failed;
  }
  return ready > 0 ? Wake::edges : Wake::timeout;
}

Drained GpioSource::drain(std::span<Edge, kBatch> into) noexcept {
  Drained drained;
  for (nfds_t i = 0; i < count_; ++i) {
    if ((polled_[i].revents & POLLIN) == 0) continue;
    std::array<gpiod_line_event, kFifo> events;
    const int got = gpiod_line_event_read_fd_multiple(polled_[i].fd, events.data(), events.size());
    if (got <= 0) continue;
    drained.full = drained.full || static_cast<std::size_t>(got) == events.size();
    for (int k = 0; k < got; ++k) {
      const gpiod_line_event& event = events[static_cast<std::size_t>(k)];
      into[drained.count++] = {
          static_cast<std::int64_t>(event.ts.tv_sec) * 1'000'000'000 + event.ts.tv_nsec,
          static_cast<EncoderLine>(i), event.event_type == GPIOD_LINE_EVENT_RISING_EDGE};
    }
  }
  return drained;
}

std::optional<Levels> GpioSource::levels() noexcept {
  const int a = lines_[0]->value();
  const int b = lines_[1]->value();
  if (a < 0 || b < 0) return std::nullopt;
  return Levels{a != 0, b != 0};
}

}  // namespace hal::encoder
