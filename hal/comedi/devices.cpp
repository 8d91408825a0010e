#include "hal/comedi/devices.h"

namespace hal::comedi {

InputReading Analog::read(Exchange& exchange, const Tick& tick) const noexcept {
  const Exchange::View& view = exchange.view(tick);
  InputReading reading;
  reading.t_ns = view.read_ns;
  reading.quality = exchange.quality(view, index, monotonic_ns());
  if (reading.quality == config::signals::Quality::bad) return reading;
  const std::uint32_t code = view.codes[index];
  reading.value = value_of_V.forward(span.volts(code));
  if (reading.quality == config::signals::Quality::good && span.at_end(code))
    reading.quality = config::signals::Quality::uncertain;
  return reading;
}

Reading AnalogRod::read(const Tick& tick) noexcept {
  const InputReading value = analog_.read(*exchange_, tick);
  Reading reading;
  reading.y_m = value.value;
  reading.t_ns = value.t_ns;
  reading.quality = value.quality;
  return reading;
}

Reading CounterRod::read(const Tick& tick) noexcept {
  const Exchange::View& view = exchange_->view(tick);
  Reading reading;
  reading.t_ns = view.read_ns;
  reading.quality = exchange_->quality(view, index_, monotonic_ns());
  if (reading.quality == config::signals::Quality::bad) return reading;
  reading.y_m = metres_.forward(static_cast<double>(unwrap_.count(view.codes[index_])));
  return reading;
}

Applied AnalogValve::write(double u_V, const Tick& tick) noexcept {
  const std::uint32_t newest = code(u_V);
  return {command_V(newest), exchange_->write(newest, tick)};
}

Applied AnalogValve::go_null() noexcept {
  const std::uint32_t null = code(null_V_);
  return {command_V(null), exchange_->write_now(null)};
}

}  // namespace hal::comedi
