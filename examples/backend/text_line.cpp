#include "examples/backend/text_line.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <string>

#include "hal/freshness.h"
#include "hal/latest.h"
#include "hal/monotonic.h"
#include "hal/thread.h"

namespace hal::text_line {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;
constexpr int kWait_ms = 5;  // a thread that is told to stop must notice soon

class TextLineSensor final : public RodSensor {
 public:
  /// Owns the descriptor.
  TextLineSensor(int descriptor, double sign, double sample_time_s)
      : descriptor_(descriptor), sign_(sign), period_ns_(std::llround(1e9 * sample_time_s)) {
    thread_.start_cyclic("text_line", {}, [this] { receive(); });
  }
  ~TextLineSensor() override {
    thread_.stop();
    close(descriptor_);
  }

  /// Called from the loop: takes the newest value, waits for nothing.
  Reading read(const Tick& tick) noexcept override {
    Reading reading = latest_.get();
    if (reading.t_ns != 0) {
      reading.quality = freshness(tick.nominal_ns - reading.t_ns, period_ns_);
    }
    return reading;
  }

 private:
  /// Body of the thread: waits for bytes, and hands on each complete line.
  void receive() {
    pollfd ready{descriptor_, POLLIN, 0};
    if (poll(&ready, 1, kWait_ms) <= 0) return;
    char bytes[256];
    const ssize_t count = ::read(descriptor_, bytes, sizeof bytes);
    if (count <= 0) {
      poll(nullptr, 0, kWait_ms);  // the other end is closed: try again later
      return;
    }
    line_.append(bytes, static_cast<std::size_t>(count));
    for (std::size_t end = 0; (end = line_.find('\n')) != std::string::npos;) {
      double y_mm = 0.0;
      const char* const last = line_.data() + end;
      const auto [stopped, error] = std::from_chars(line_.data(), last, y_mm);
      if (error == std::errc() && stopped == last && std::isfinite(y_mm)) {
        Reading reading;
        reading.y_m = sign_ * kMetresPerMillimetre * y_mm;
        reading.t_ns = monotonic_ns();
        reading.quality = config::signals::Quality::good;
        latest_.put(reading);
      }
      line_.erase(0, end + 1);
    }
    if (line_.size() > sizeof bytes) line_.clear();  // no line at all: noise
  }

  int descriptor_;
  double sign_;
  std::int64_t period_ns_;
  std::string line_;
  Latest<Reading> latest_;
  Thread thread_;
};

}  // namespace

void TextLineConfig::visit(config::schema::Visitor& v) {
  v.text({"device", "serial line or pipe, relative to the configuration's folder", true}, device);
  v.number(config::schema::wiring({"sign", "1, or -1 where the reading falls as the rod extends"}),
           sign, {-1.0, 1.0});
}

BackendDevices TextLineBackend::open(const OpenContext& context) const {
  const std::string path = resolve(context, config_.device).string();
  // Read and write, so that a pipe without a writer can be opened.
  const int descriptor = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) {
    throw config::schema::DeviceUnavailable(context.file + ": [text_line] device: " + path + ": " +
                                            std::strerror(errno));
  }
  BackendDevices devices;
  devices.rods[kRodChannel] =
      std::make_shared<TextLineSensor>(descriptor, config_.sign, context.sample_time_s);
  return devices;
}

}  // namespace hal::text_line
