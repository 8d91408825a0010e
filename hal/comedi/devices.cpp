#include "hal/comedi/devices.h"

namespace hal::comedi {

InputReading Analog::read(Exchange& exchange, const Tick& tick) const noexcept {
  const Exchange::View& view = exchange.view(tick);
  InputReading reading;
  reading.t_ns = view.read_ns;
  if (!view.good[index]) return reading;
  const std::uint32_t code = view.codes[index];
  reading.value = value_of_V.forward(span.volts(code));
  reading.quality = exchange.stale(view.read_ns, monotonic_ns()) ? Quality::stale
                    : span.at_end(code)                          ? Quality::uncertain
                                                                 : Quality::good;
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
  if (!view.good[index_]) return reading;
  reading.y_m = metres_.forward(static_cast<double>(unwrap_.count(view.codes[index_])));
  const bool stale = exchange_->stale(view.read_ns, monotonic_ns());
  reading.quality = stale ? Quality::stale : Quality::good;
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
