#include "config/units/quantity.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "config/units/printed_scale.h"

namespace config::units {
namespace {

/// "N" of "N", "s2" of "s2", "m3/s" of "m3ps"; "" when it is no unit.
std::string unit_word(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> kUnits[] = {
      {"m3ps", "m3/s"}, {"mps2", "m/s2"}, {"mps", "m/s"}, {"rad", "rad"},
      {"Pa", "Pa"},     {"kg", "kg"},     {"Hz", "Hz"},   {"N", "N"},
      {"V", "V"},       {"m", "m"},       {"s", "s"}};
  for (const auto& [name, unit] : kUnits) {
    if (word == name) return std::string(unit);
    const bool power = word.size() == name.size() + 1 && word.starts_with(name) &&
                       word.back() >= '2' && word.back() <= '9' && unit == name;
    if (power) return std::string(word);
  }
  return "";
}

bool ends_with(std::string_view text, std::string_view ending) {
  return text.size() >= ending.size() && text.substr(text.size() - ending.size()) == ending;
}

/// The parameter that a change gives a value, "change.mass_kg" for "change.mass_kg.value" and for
/// "change.mass_kg@monday.csv.value"; other names as they are.
std::string_view changed_parameter(std::string_view name) {
  constexpr std::string_view kValue = ".value";
  if (ends_with(name, kValue)) name.remove_suffix(kValue.size());
  return name.substr(0, name.find('@'));
}

}  // namespace

std::string unit_of(std::string_view name) {
  name = changed_parameter(name);
  // From the end, words that are units; one "per" among them divides. The first word is the name.
  std::string unit;
  std::string below;
  bool divided = false;
  for (std::size_t bar = name.rfind('_'); bar != std::string_view::npos && bar > 0;
       bar = name.rfind('_')) {
    const std::string_view word = name.substr(bar + 1);
    if (word == "per" && !divided && !unit.empty()) {
      divided = true;
      std::swap(unit, below);
    } else {
      std::string one = unit_word(word);
      if (one.empty()) break;
      if (!unit.empty()) one.append(" ").append(unit);
      unit = std::move(one);
    }
    name = name.substr(0, bar);
  }
  if (!divided) return unit;
  if (unit.empty()) return "1/" + below;
  const bool compound = below.find_first_of(" /") != std::string::npos;
  return unit + "/" + (compound && below != "s" ? "(" + below + ")" : below);
}

namespace {

struct PrintedUnit {
  const char* si;
  const char* unit;
  double in_si;  ///< one of the unit
  double from;   ///< used for |value| from here on, SI
};

thread_local Motion printed_motion = Motion::linear;

/// "rad" of "m", "mrad" of "mm", "kg m2" of "kg"; other words stay. "rad2" of "m2".
std::string rotary_word(std::string_view word) {
  static constexpr std::pair<std::string_view, std::string_view> kWords[] = {
      {"um", "urad"}, {"µm", "µrad"}, {"mm", "mrad"}, {"m", "rad"},
      {"kN", "kN m"}, {"N", "N m"},   {"kg", "kg m2"}};
  for (const auto& [linear, rotary] : kWords) {
    if (word == linear) return std::string(rotary);
    if (linear == "m" && word.size() == 2 && word.front() == 'm' && word.back() >= '2' &&
        word.back() <= '9') {
      return "rad" + std::string(word.substr(1));
    }
  }
  return std::string(word);
}

constexpr double kLitrePerMinute_m3ps = 1e-3 / 60.0;
constexpr double kBar_Pa = 1e5;
constexpr double kRoundsUp = 0.9995;  // in three digits

/// Units of one SI unit are sorted by size, largest first.
constexpr std::array kUnits{
    PrintedUnit{"m", "m", 1.0, 1.0},
    PrintedUnit{"m", "mm", 1e-3, 1e-3},
    PrintedUnit{"m", "um", 1e-6, 0.0},
    PrintedUnit{"m/s", "m/s", 1.0, 1.0},
    PrintedUnit{"m/s", "mm/s", 1e-3, 1e-4},
    PrintedUnit{"m/s", "um/s", 1e-6, 0.0},
    PrintedUnit{"m/s/V", "mm/s/V", 1e-3, 0.0},
    PrintedUnit{"m/V", "mm/V", 1e-3, 1e-3},
    PrintedUnit{"m/V", "um/V", 1e-6, 0.0},
    PrintedUnit{"s", "s", 1.0, 1.0},
    PrintedUnit{"s", "ms", 1e-3, 0.0},
    PrintedUnit{"V", "V", 1.0, 0.1},
    PrintedUnit{"V", "mV", 1e-3, 0.0},
    PrintedUnit{"Pa", "bar", kBar_Pa, 1e4},
    PrintedUnit{"Pa", "Pa", 1.0, 0.0},
    PrintedUnit{"N", "kN", 1e3, 1e4},
    PrintedUnit{"N", "N", 1.0, 0.0},
    PrintedUnit{"N/m", "N/mm", 1e3, 1e4},
    PrintedUnit{"N/m", "N/m", 1.0, 0.0},
    PrintedUnit{"m3/s", "L/min", kLitrePerMinute_m3ps, 0.0},
    PrintedUnit{"m3/s/Pa", "mL/min/bar", 1e-3 * kLitrePerMinute_m3ps / kBar_Pa, 0.0},
    PrintedUnit{"Pa/(m3/s)", "bar/(L/min)", kBar_Pa / kLitrePerMinute_m3ps, 0.0},
    PrintedUnit{"m2", "cm2", 1e-4, 0.0},
    PrintedUnit{"m3", "cm3", 1e-6, 0.0},
    PrintedUnit{"rad", "deg", 3.14159265358979323846 / 180.0, 0.0},
    PrintedUnit{"ratio", "%", 0.01, 0.0},
};

std::string si_unit(std::string_view name) {
  return ends_with(changed_parameter(name), "_ratio") ? "ratio" : unit_of(name);
}

PrintedUnit unit_for(const std::string& si, double size) {
  // a torsional stiffness is per radian at any size
  if (si == "N/m" && motion() == Motion::rotary) size = 0.0;
  const bool angle = si == "m2" && motion() == Motion::rotary;
  for (const PrintedUnit& unit : kUnits) {
    if (!angle && si == unit.si && size >= kRoundsUp * unit.from) return unit;
  }
  return {si.c_str(), si.c_str(), 1.0, 0.0};
}

int exponent(double x) { return static_cast<int>(std::floor(std::log10(x) + 1e-12)); }

/// As many decimals as the error allows: its first digit, two where that is 1 or 2.
int decimals_for(double value, double error) {
  constexpr int kMostDigits = 6;
  const int last = exponent(error) - (error / std::pow(10.0, exponent(error)) < 2.95 ? 1 : 0);
  const int least = value == 0.0 ? -kMostDigits : exponent(std::abs(value)) - (kMostDigits - 1);
  return std::max(0, -std::max(last, least));
}

std::string fixed(double value, int decimals) {
  const bool plain = std::abs(value) < 1e6 && decimals <= 9;
  return plain ? fmt::format("{:.{}f}", value, decimals) : fmt::format("{:.4g}", value);
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

PrintedAxis::PrintedAxis(Motion motion) noexcept : before_(std::exchange(printed_motion, motion)) {}

PrintedAxis::~PrintedAxis() { printed_motion = before_; }

Motion motion() noexcept { return printed_motion; }

std::string moving_part() { return motion() == Motion::linear ? "rod" : "axis"; }

std::string axis_unit(std::string_view unit) {
  if (motion() == Motion::linear) return std::string(unit);
  std::string out;
  std::size_t from = 0;
  while (from < unit.size()) {
    const std::size_t to = std::min(unit.find_first_of(" /()", from), unit.size());
    out += rotary_word(unit.substr(from, to - from));
    if (to < unit.size()) out += unit[to];
    from = to + 1;
  }
  return out;
}

std::string axis_words(std::string_view text) {
  if (motion() == Motion::linear) return std::string(text);
  static constexpr std::pair<std::string_view, std::string_view> kWords[] = {
      {"extending", "turning forwards"},
      {"retracting", "turning backwards"},
      {"extends", "turns forwards"},
      {"extension", "forward motion"},
      {"retraction", "backward motion"},
      {"force", "torque"},
      {"forces", "torques"},
      {"mass", "inertia"},
      {"rod", "axis"},
      {"stroke", "angle"}};
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  std::string out;
  for (std::size_t from = 0; from < text.size();) {
    std::size_t to = from;
    while (to < text.size() && letter(text[to])) ++to;
    const std::string_view word = text.substr(from, to - from);
    const auto* const known = std::find_if(std::begin(kWords), std::end(kWords),
                                           [&](const auto& one) { return one.first == word; });
    out += known == std::end(kWords) ? word : known->second;
    if (to < text.size()) out += text[to];
    from = to + 1;
  }
  return out;
}

std::string three_digits(double value) {
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  return size >= 100.0 && size < 1e5 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

Quantity quantity(std::string_view name, double value, double std_error, double reference) {
  if (std::isinf(value)) return {"no limit", "", ""};
  if (std::isnan(value)) return {"unknown", "", ""};
  const std::string si = si_unit(name);
  const double size =
      std::max(std::abs(value), std::isfinite(reference) ? std::abs(reference) : 0.0);
  const PrintedUnit unit = unit_for(si, size);
  const double shown = value / unit.in_si;
  const double error = std_error / unit.in_si;
  const std::string text = axis_unit(unit.unit);
  if (!(error > 0.0) || std::isinf(error)) return {three_digits(shown), "", text};
  if (error > 1e3 * std::abs(shown)) return {three_digits(shown), three_digits(error), text};
  const int decimals = decimals_for(shown, error);
  const bool lost = error < 0.5 * std::pow(10.0, -decimals);
  return {fixed(shown, decimals), lost ? fmt::format("{:.1g}", error) : fixed(error, decimals),
          text};
}

PrintedScale printed_scale(std::string_view name, double size) {
  const std::string si = si_unit(name);
  const PrintedUnit unit = unit_for(si, std::abs(size));
  return {axis_unit(unit.unit), unit.in_si};
}

std::string words(const Quantity& quantity) {
  return quantity.value + (quantity.error.empty() ? "" : " +- " + quantity.error) +
         (quantity.unit.empty() ? "" : " " + quantity.unit);
}

std::string length_words(double length_m) {
  return std::isfinite(length_m) ? words(quantity("length_m", length_m, std::nan(""))) : "-";
}

std::string speed_words(double speed_mps) {
  return std::isfinite(speed_mps) ? words(quantity("speed_mps", speed_mps, std::nan(""))) : "-";
}

std::string chance_words(double p) {
  if (!std::isfinite(p)) return "-";
  return p < 1e-6 ? "< 1e-6" : fmt::format("{:.2g}", p);
}

std::string times_words(double ratio) {
  if (!std::isfinite(ratio)) return "-";
  if (ratio > 0.0 && ratio < 0.01) return fmt::format("{:.1g}", ratio);
  return fmt::format("{:.{}f}", ratio, ratio < 10.0 ? 2 : ratio < 100.0 ? 1 : 0);
}

std::string parameter_words(std::string_view name) {
  if (const auto dot = name.rfind('.'); dot != std::string_view::npos) name.remove_prefix(dot + 1);
  if (name == "coulomb_N") return "Coulomb";
  if (name == "stribeck_mps") return "Stribeck speed";
  std::string text(name);
  // the first word is never a unit
  for (auto bar = text.rfind('_'); bar != std::string::npos; bar = text.rfind('_')) {
    const std::string rest = text.substr(bar + 1);
    const bool unit = rest == "per" || rest == "ratio" || !unit_of("x_" + rest).empty();
    if (!unit) break;
    text.resize(bar);
  }
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string typeset(std::string text) {
  replace_all(text, " +- ", " ± ");
  replace_all(text, " um", " µm");
  replace_all(text, " urad", " µrad");
  return text;
}

}  // namespace config::units
