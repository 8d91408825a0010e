#include "hal/comedi/comedi.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>

#include "config/schema/error.h"
#include "hal/comedi/devices.h"

namespace hal::comedi {
namespace {

using config::schema::bad_config;

std::string text(double value) { return fmt::format("{:.6g}", value); }

/// The range must reach null and, where it is known, a whole limit_V to both sides of it.
void check_reach(const std::string& table, const ConverterSpan& span, const Linear& terminal_V,
                 const OpenContext& context) {
  const double limit_V = std::isnan(context.limit_V) ? 0.0 : context.limit_V;
  for (const double side : {-1.0, 1.0}) {
    const double command_V = context.null_V + side * limit_V;
    const double volts = terminal_V.forward(command_V);
    // The last code of a converter may be one step short of the round number.
    if (volts < span.min_V - span.step_V() || volts > span.max_V + span.step_V()) {
      throw bad_config(table + " range",
                       "reaches from " + text(span.min_V) + " to " + text(span.max_V) +
                           " V, but a command of " + text(command_V) + " V needs " + text(volts) +
                           " V",
                       "a range that holds null_V +- limit_V through scale, offset and polarity");
    }
  }
}

int counter_bits(const std::string& table, std::int64_t configured, std::uint32_t max_code) {
  const int board = std::bit_width(max_code);
  if (configured > board) {
    throw bad_config(table + " bits", "is " + std::to_string(configured),
                     "up to " + std::to_string(board) + ", which the board has");
  }
  return configured == 0 ? board : static_cast<int>(configured);
}

std::string summary(Exchange& exchange) {
  const Exchange::View& view = exchange.view({});
  return "comedi: " + std::to_string(view.read_failures) + " reads and " +
         std::to_string(view.write_failures) + " writes failed";
}

}  // namespace

BackendDevices ComediBackend::open(const OpenContext& context) const {
  config_.check(context.file);
  const std::string prefix = context.file + ": [comedi";
  const auto board = std::make_shared<ComediBoard>(prefix + "] device", config_.device);
  std::vector<BoardChannel> places;
  const auto place = [&](const std::string& table, ChannelKind kind, const ChannelConfig& channel) {
    places.push_back(board->find(table, kind, channel));
    return places.size() - 1;
  };
  std::vector<Analog> inputs;
  for (std::size_t i = 0; i < config_.inputs.size(); ++i) {
    const ComediInputConfig& input = config_.inputs[i];
    const std::string table = context.file + ": [[comedi.input]] " + std::to_string(i + 1);
    const std::size_t index = place(table, ChannelKind::analog_input, input.channel);
    inputs.push_back({index, board->span(table, places[index]), {input.scale_per_V, input.offset}});
  }
  const RodConfig& rod = config_.rod;
  const bool counter = rod.kind == "counter";
  const std::string rod_table = prefix + ".rod]";
  std::size_t rod_index = 0;
  if (config_.has_rod) {
    rod_index =
        place(rod_table, counter ? ChannelKind::counter : ChannelKind::analog_input, rod.channel);
  }
  BoardChannel output;
  ConverterSpan output_span;
  if (config_.has_output) {
    const std::string table = prefix + ".output]";
    output = board->find(table, ChannelKind::analog_output, config_.output.channel);
    output_span = board->span(table, output);
    check_reach(table, output_span, config_.output.terminal_V(), context);
    board->lock(table, output);
  }

  const auto exchange = std::make_shared<Exchange>(
      board, places, output, static_cast<std::int64_t>(context.sample_time_s * 1e9));
  BackendDevices devices;
  if (config_.has_rod && counter) {
    const int bits = counter_bits(rod_table, rod.bits, board->max_code(places[rod_index]));
    devices.rods[kRodChannel] = std::make_shared<CounterRod>(
        exchange, rod_index, bits,
        Linear{static_cast<double>(rod.sign) * rod.resolution_m, rod.offset_m});
  } else if (config_.has_rod) {
    devices.rods[kRodChannel] =
        std::make_shared<AnalogRod>(exchange, Analog{rod_index,
                                                     board->span(rod_table, places[rod_index]),
                                                     {rod.scale_m_per_V, rod.offset_m}});
  }
  if (config_.has_output) {
    devices.valve = std::make_shared<AnalogValve>(exchange, output_span,
                                                  config_.output.terminal_V(), context.null_V);
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    devices.inputs[config_.inputs[i].name] = std::make_shared<AnalogInput>(exchange, inputs[i]);
  }
  exchange->start(config_.threaded, static_cast<int>(config_.priority));
  devices.summary = [exchange] { return summary(*exchange); };
  return devices;
}

}  // namespace hal::comedi
