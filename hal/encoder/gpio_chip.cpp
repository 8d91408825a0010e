#include "hal/encoder/gpio_chip.h"

#include <fcntl.h>
#include <time.h>
#include <cerrno>
#include <cstring>
#include <utility>

#include "config/schema/error.h"

namespace hal::encoder {
namespace {

using config::schema::bad_config;

/// "gpiochip0 (pinctrl), gpiochip1 (ftdi)".
std::string all_chips() {
  std::string names;
  gpiod_chip_iter* iterator = gpiod_chip_iter_new();
  if (iterator == nullptr) return "a GPIO chip; this machine has none";
  while (gpiod_chip* chip = gpiod_chip_iter_next(iterator)) {
    names += (names.empty() ? "" : ", ") + std::string(gpiod_chip_name(chip)) + " (" +
             gpiod_chip_label(chip) + ")";
  }
  gpiod_chip_iter_free(iterator);
  return names.empty() ? "a GPIO chip; this machine has none" : names;
}

int flags_of(const Wiring& wiring) {
  int flags = wiring.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (wiring.bias == "pull_up") flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (wiring.bias == "pull_down") flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  if (wiring.bias == "disabled") flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
  return flags;
}

int request_line(gpiod_line* line, Use use, int flags) {
  const gpiod_line_request_config as_is{kConsumer, GPIOD_LINE_REQUEST_DIRECTION_AS_IS, 0};
  switch (use) {
    case Use::edges:
      return gpiod_line_request_both_edges_events_flags(line, kConsumer, flags);
    case Use::input:
      return gpiod_line_request_input_flags(line, kConsumer, flags);
    case Use::output:
      return gpiod_line_request_output_flags(line, kConsumer, flags, 0);
    case Use::claim:
      break;
  }
  return gpiod_line_request(line, &as_is, 0);
}

}  // namespace

std::shared_ptr<GpioChip> GpioChip::open(const std::string& where, const std::string& description) {
  gpiod_chip* chip = gpiod_chip_open_lookup(description.c_str());
  if (chip == nullptr) {
    const int error = errno;
    throw config::schema::DeviceUnavailable(config::schema::error_line(
        where, "is \"" + description + "\": " + std::strerror(error),
        error == EACCES ? "a GPIO chip that this user may open" : all_chips()));
  }
  return std::shared_ptr<GpioChip>(new GpioChip(chip));
}

std::shared_ptr<GpioLine> GpioChip::request(const std::string& where, std::int64_t offset, Use use,
                                            const Wiring& wiring) {
  const unsigned lines = gpiod_chip_num_lines(chip_);
  const std::string name = gpiod_chip_name(chip_);
  if (offset < 0 || offset >= lines) {
    throw bad_config(where, "is " + std::to_string(offset),
                     name + " has lines 0 to " + std::to_string(lines - 1));
  }
  gpiod_line* line = gpiod_chip_get_line(chip_, static_cast<unsigned>(offset));
  int result = -1;
  if (line != nullptr) {
    result = request_line(line, use, flags_of(wiring));
  }
  if (result != 0) {
    const int error = errno;
    std::string what = "is " + std::to_string(offset) + " of " + name;
    if (error == EBUSY) {
      const char* holder = gpiod_line_consumer(line);
      what += ", which is in use by " + (holder == nullptr ? "the kernel or another program"
                                                           : "\"" + std::string(holder) + "\"");
    } else {
      what += std::string(", which cannot be requested: ") + std::strerror(error);
    }
    throw bad_config(where, what,
                     use == Use::edges ? "a free line that signals edges" : "a free line");
  }
  auto requested = std::make_shared<GpioLine>(shared_from_this(), line);
  if (use == Use::edges) fcntl(requested->fd(), F_SETFL, O_NONBLOCK);
  return requested;
}

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
