// Devices served by an Exchange. Used by the loop's thread; go_null() by any thread.
#pragma once

#include <memory>
#include <utility>

#include "hal/comedi/exchange.h"

namespace hal::comedi {

/// An analogue channel as a physical value; uncertain at the ends of the converter's range.
struct Analog {
  std::size_t index = 0;  ///< among the exchange's inputs
  ConverterSpan span;
  Linear value_of_V;

  [[nodiscard]] InputReading read(Exchange& exchange, const Tick& tick) const noexcept;
};

class AnalogInput final : public Input {
 public:
  AnalogInput(std::shared_ptr<Exchange> exchange, const Analog& analog) noexcept
      : exchange_(std::move(exchange)), analog_(analog) {}
  InputReading read(const Tick& tick) noexcept override { return analog_.read(*exchange_, tick); }

 private:
  std::shared_ptr<Exchange> exchange_;
  Analog analog_;
};

class AnalogRod final : public RodSensor {
 public:
  AnalogRod(std::shared_ptr<Exchange> exchange, const Analog& analog) noexcept
      : exchange_(std::move(exchange)), analog_(analog) {}
  Reading read(const Tick& tick) noexcept override;

 private:
  std::shared_ptr<Exchange> exchange_;
  Analog analog_;
};

class CounterRod final : public RodSensor {
 public:
  /// `metres`: of the counts since the start.
  CounterRod(std::shared_ptr<Exchange> exchange, std::size_t index, int bits,
             const Linear& metres) noexcept
      : exchange_(std::move(exchange)), index_(index), unwrap_(bits), metres_(metres) {}
  Reading read(const Tick& tick) noexcept override;

 private:
  std::shared_ptr<Exchange> exchange_;
  std::size_t index_;
  Unwrap unwrap_;
  Linear metres_;
};

class AnalogValve final : public ValveDrive {
 public:
  AnalogValve(std::shared_ptr<Exchange> exchange, const ConverterSpan& span,
              const Linear& terminal_V, double null_V) noexcept
      : exchange_(std::move(exchange)), span_(span), terminal_V_(terminal_V), null_V_(null_V) {}
  Applied write(double u_V, const Tick& tick) noexcept override;
  Applied go_null() noexcept override;

 private:
  [[nodiscard]] std::uint32_t code(double u_V) const noexcept {
    return span_.code(terminal_V_.forward(u_V));
  }
  [[nodiscard]] double command_V(std::uint32_t code) const noexcept {
    return terminal_V_.back(span_.volts(code));
  }

  std::shared_ptr<Exchange> exchange_;
  ConverterSpan span_;
  Linear terminal_V_;
  double null_V_;
};

}  // namespace hal::comedi
