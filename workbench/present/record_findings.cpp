#include "workbench/present/record_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "config/record/unit_text.h"
#include "config/units/quantity.h"
#include "workbench/present/shell_command.h"

namespace workbench::present {
namespace {

using greybox::ScaleError;
using greybox::SourceColumn;

/// Units of which the second is a thousandth of the first.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kThousandths{
    {{"m", "mm"}, {"mm", "um"}, {"V", "mV"}, {"A", "mA"}, {"s", "ms"}, {"ms", "us"}, {"kN", "N"}}};

constexpr double kGreatest_V = 1000.0;
constexpr double kGreatest_A = 1000.0;
constexpr double kSlowest_s = 1.0;
constexpr double kFastest_s = 2e-5;

std::string thousandth_of(const std::string& unit) {
  for (const auto& [large, small] : kThousandths) {
    if (unit == large) return std::string(small);
  }
  return {};
}

std::string thousand_of(const std::string& unit) {
  for (const auto& [large, small] : kThousandths) {
    if (unit == small) return std::string(large);
  }
  return {};
}

std::string map_words(const char* key, const std::string& column) {
  return "--map " + shell_word(std::string(key) + "=" + column);
}

/// How a mapping names the column: "Position" for "Position [mm]".
std::string name_of(const SourceColumn& column) {
  const std::string& header = column.header;
  if (header.find_first_of("[(") == std::string::npos) return header;
  const std::string name = config::record::parse_header(header).name;
  return name.empty() ? header : name;
}

/// "--map y=Position" or y=-Position, with the unit where the header does not name it.
std::string signed_map(const char* sign, const SourceColumn& position) {
  std::string value = sign + name_of(position);
  if (config::record::parse_header(position.header).unit.text != position.unit) {
    value += "[" + position.unit + "]";
  }
  return map_words("y", value);
}

/// "is it mm? --map 'y=Position[mm]'"
std::string unit_question(const char* key, const SourceColumn& column, const std::string& unit) {
  if (unit.empty()) return "is its unit right?";
  std::string text = "is it " + unit + "?";
  if (!column.header.empty())
    text += " " + map_words(key, (column.turned ? "-" : "") + name_of(column) + "[" + unit + "]");
  return text;
}

const config::record::ChannelOrigin* origin_of(const config::record::Record& record,
                                               const std::string& name) {
  for (const config::record::ChannelOrigin& origin : record.origins) {
    if (origin.name == name) return &origin;
  }
  return nullptr;
}

SourceColumn source_of(const config::record::Record& record, const std::string& name) {
  const config::record::ChannelOrigin* const origin = origin_of(record, name);
  return origin == nullptr ? SourceColumn{}
                           : SourceColumn{origin->header, origin->unit, origin->factor < 0.0};
}

std::vector<std::string> size_findings(const config::record::Record& record) {
  std::vector<std::string> out;
  if (record.has_position && record.position_unit == "m") {
    const auto [low_m, high_m] = greybox::usual_range(record.y_m);
    std::string text = travel_finding(low_m, high_m, source_of(record, "y_m"));
    if (!text.empty()) out.push_back(std::move(text));
  }
  const auto [low, high] = greybox::usual_range(record.u_V);
  const double greatest = std::max(std::abs(low), std::abs(high));
  const std::string& unit = record.command_unit;
  if ((unit == "V" && greatest > kGreatest_V) || (unit == "A" && greatest > kGreatest_A)) {
    const SourceColumn source = source_of(record, "u_" + unit);
    out.push_back(fmt::format("the command reaches {:.3g} {}: ", greatest, unit) +
                  unit_question("u", source, thousandth_of(source.unit)));
  }
  const SourceColumn time = source_of(record, "t_s");
  if (time.unit == "s" && record.sample_time_s >= kSlowest_s) {
    out.push_back(fmt::format("the time steps by {:.3g} s: ", record.sample_time_s) +
                  unit_question("t", time, thousandth_of(time.unit)));
  } else if (record.sample_time_s <= kFastest_s && !thousand_of(time.unit).empty()) {
    out.push_back(fmt::format("the time steps by {:.3g} us: ", 1e6 * record.sample_time_s) +
                  unit_question("t", time, thousand_of(time.unit)));
  }
  return out;
}

std::string advance_words(double s) {
  return fmt::format("--advance of about {:.4g}, beside one already given, takes the command {}", s,
                     s > 0.0 ? "earlier" : "later");
}

}  // namespace

std::string turned_position_finding(const SourceColumn& position) {
  const std::string map =
      position.header.empty() ? "" : " (" + signed_map(position.turned ? "" : "-", position) + ")";
  return "the position moves against the command and lies within the model's stroke only when "
         "turned: its sign is turned" +
         map +
         ", or that of the command is (--flip) and the sensor counts back from the far end, where "
         "the stroke is to be added";
}

std::string exchanging_map(const SourceColumn& command, const SourceColumn& position) {
  if (command.header.empty() || position.header.empty()) return {};
  return map_words("u", name_of(position) + ",y=" + name_of(command));
}

std::vector<std::string> response_findings(const greybox::CommandResponse& response,
                                           const SourceColumn& command,
                                           const SourceColumn& position) {
  std::vector<std::string> out;
  if (response.columns_exchanged()) {
    const std::string text = fmt::format(
        "command and position look exchanged (the command's derivative correlates with the "
        "position "
        "by {:.2f}, as a position's does with its command): name the columns the other way round",
        response.exchanged);
    const std::string map = exchanging_map(command, position);
    return {map.empty() ? text : text + ", " + map};
  }
  if (response.against_command()) {
    std::string text = fmt::format(
        "the position moves against the command (speed and command correlate by {:.2f}): is a sign "
        "turned? A positive command {}",
        response.correlation, config::units::axis_words("extends"));
    // turned, a position leaves the stroke, unless a mapping has turned it before
    const bool back = position.turned && !position.header.empty();
    out.push_back(text + "; " + (back ? signed_map("", position) : "--flip turns the command"));
  }
  const std::string time = config::units::words(
      config::units::quantity("delay_s", std::abs(response.delay_s), std::nan("")));
  if (response.delay_s < 0.0) {
    out.push_back("the position moves " + time +
                  " before the command that drives it: the clocks of the two are shifted; " +
                  advance_words(-response.delay_s));
  } else if (response.delay_s > 0.0) {
    out.push_back("the position follows the command " + time +
                  " late: a dead time of the rig, or clocks that are shifted: " +
                  advance_words(-response.delay_s));
  }
  return out;
}

std::string stroke_finding(double low_m, double high_m, double stroke_m,
                           const SourceColumn& position) {
  switch (greybox::scale_error(low_m, high_m, stroke_m)) {
    case ScaleError::none:
      break;
    case ScaleError::thousandfold:
      return fmt::format(
                 "the position looks 1000 times too large for stroke_m = {:.4g} (span {:.3g} m): ",
                 stroke_m, high_m - low_m) +
             unit_question("y", position, thousandth_of(position.unit));
    case ScaleError::thousandth:
      return fmt::format(
                 "the position looks 1000 times too small for stroke_m = {:.4g} (from {:.3g} to "
                 "{:.3g} mm): ",
                 stroke_m, 1e3 * low_m, 1e3 * high_m) +
             unit_question("y", position, thousand_of(position.unit));
  }
  return {};
}

std::string travel_finding(double low_m, double high_m, const SourceColumn& position) {
  const bool linear = config::units::motion() == config::units::Motion::linear;
  if (!linear || !(high_m - low_m > greybox::kLongest_m)) return {};
  return fmt::format("the position spans {:.3g} m, more than a stand's stroke: ", high_m - low_m) +
         unit_question("y", position, thousandth_of(position.unit));
}

std::string motion_finding(const greybox::MotionRatio& motion, const SourceColumn& command,
                           const SourceColumn& position) {
  const ScaleError error = greybox::scale_error(motion);
  if (error == ScaleError::none) return {};
  const bool far = error == ScaleError::thousandfold;
  const std::string of_position = far ? thousandth_of(position.unit) : thousand_of(position.unit);
  const std::string of_command = far ? thousand_of(command.unit) : thousandth_of(command.unit);
  std::string text = far ? fmt::format("the {} moves {:.4g} times as far as the model",
                                       config::units::moving_part(), motion.ratio)
                         : fmt::format("the {} moves 1/{:.4g} as far as the model",
                                       config::units::moving_part(), 1.0 / motion.ratio);
  if (of_position.empty() && of_command.empty()) return text + ": is a unit wrong?";
  text += ": ";
  if (!of_position.empty()) {
    text += "the position: " + unit_question("y", position, of_position);
  }
  if (!of_command.empty()) {
    text += std::string(of_position.empty() ? "" : "; or ") +
            "the command: " + unit_question("u", command, of_command);
  }
  return text;
}

std::string size_finding(const greybox::ValueRange& range, double stroke_m,
                         const greybox::MotionRatio& motion, const SourceColumn& command,
                         const SourceColumn& position) {
  const bool has_stroke = stroke_m > 0.0;
  std::string text =
      has_stroke ? stroke_finding(range.low, range.high, stroke_m, position) : std::string();
  if (text.empty()) text = motion_finding(motion, command, position);
  if (!text.empty() || has_stroke) return text;
  return travel_finding(range.low, range.high, position);
}

std::vector<std::string> record_findings(const config::record::Record& record) {
  std::vector<std::string> out = size_findings(record);
  if (!record.has_position) return out;
  const greybox::CommandResponse response =
      greybox::command_response(record.sample_time_s, record.u_V, record.y_m, record.gaps);
  for (std::string& text :
       response_findings(response, source_of(record, "u_" + record.command_unit),
                         source_of(record, "y_" + record.position_unit))) {
    out.push_back(std::move(text));
  }
  return out;
}

}  // namespace workbench::present
