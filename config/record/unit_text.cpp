#include "config/record/unit_text.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace config::record {
namespace {

struct KnownUnit {
  std::string_view text;
  std::string_view si;
  double factor;
};

constexpr double kPi = 3.14159265358979323846;
constexpr double kPsi_Pa = 6894.757293168361;
constexpr double kInch_m = 0.0254;
constexpr double kLitrePerMinute_m3ps = 1e-3 / 60.0;
constexpr double kPoundForce_N = 4.4482216152605;
constexpr double kUsGallon_m3 = 3.785411784e-3;

constexpr std::array kUnits{
    KnownUnit{"s", "s", 1.0},
    KnownUnit{"sec", "s", 1.0},
    KnownUnit{"secs", "s", 1.0},
    KnownUnit{"second", "s", 1.0},
    KnownUnit{"seconds", "s", 1.0},
    KnownUnit{"Sekunde", "s", 1.0},
    KnownUnit{"Sekunden", "s", 1.0},
    KnownUnit{"ms", "s", 1e-3},
    KnownUnit{"msec", "s", 1e-3},
    KnownUnit{"millisecond", "s", 1e-3},
    KnownUnit{"milliseconds", "s", 1e-3},
    KnownUnit{"us", "s", 1e-6},
    KnownUnit{"µs", "s", 1e-6},
    KnownUnit{"usec", "s", 1e-6},
    KnownUnit{"microseconds", "s", 1e-6},
    KnownUnit{"ns", "s", 1e-9},
    KnownUnit{"min", "s", 60.0},
    KnownUnit{"minutes", "s", 60.0},
    KnownUnit{"V", "V", 1.0},
    KnownUnit{"Volt", "V", 1.0},
    KnownUnit{"Volts", "V", 1.0},
    KnownUnit{"mV", "V", 1e-3},
    KnownUnit{"A", "A", 1.0},
    KnownUnit{"Amp", "A", 1.0},
    KnownUnit{"Amps", "A", 1.0},
    KnownUnit{"Ampere", "A", 1.0},
    KnownUnit{"mA", "A", 1e-3},
    KnownUnit{"%", "pct", 1.0},
    KnownUnit{"pct", "pct", 1.0},
    KnownUnit{"percent", "pct", 1.0},
    KnownUnit{"Prozent", "pct", 1.0},
    KnownUnit{"N", "N", 1.0},
    KnownUnit{"kN", "N", 1e3},
    KnownUnit{"daN", "N", 10.0},
    KnownUnit{"lbf", "N", kPoundForce_N},
    KnownUnit{"Nm", "Nm", 1.0},
    KnownUnit{"N m", "Nm", 1.0},
    KnownUnit{"N*m", "Nm", 1.0},
    KnownUnit{"N.m", "Nm", 1.0},
    KnownUnit{"N·m", "Nm", 1.0},
    KnownUnit{"kNm", "Nm", 1e3},
    KnownUnit{"mNm", "Nm", 1e-3},
    KnownUnit{"Ncm", "Nm", 1e-2},
    KnownUnit{"m", "m", 1.0},
    KnownUnit{"metre", "m", 1.0},
    KnownUnit{"meter", "m", 1.0},
    KnownUnit{"metres", "m", 1.0},
    KnownUnit{"meters", "m", 1.0},
    KnownUnit{"cm", "m", 1e-2},
    KnownUnit{"mm", "m", 1e-3},
    KnownUnit{"millimetre", "m", 1e-3},
    KnownUnit{"millimeter", "m", 1e-3},
    KnownUnit{"millimetres", "m", 1e-3},
    KnownUnit{"millimeters", "m", 1e-3},
    KnownUnit{"um", "m", 1e-6},
    KnownUnit{"µm", "m", 1e-6},
    KnownUnit{"in", "m", kInch_m},
    KnownUnit{"inch", "m", kInch_m},
    KnownUnit{"inches", "m", kInch_m},
    KnownUnit{"ft", "m", 12.0 * kInch_m},
    KnownUnit{"rad", "rad", 1.0},
    KnownUnit{"radian", "rad", 1.0},
    KnownUnit{"radians", "rad", 1.0},
    KnownUnit{"mrad", "rad", 1e-3},
    KnownUnit{"deg", "rad", kPi / 180.0},
    KnownUnit{"degree", "rad", kPi / 180.0},
    KnownUnit{"degrees", "rad", kPi / 180.0},
    KnownUnit{"°", "rad", kPi / 180.0},
    KnownUnit{"rev", "rad", 2.0 * kPi},
    KnownUnit{"revs", "rad", 2.0 * kPi},
    KnownUnit{"m/s", "mps", 1.0},
    KnownUnit{"mps", "mps", 1.0},
    KnownUnit{"mm/s", "mps", 1e-3},
    KnownUnit{"mmps", "mps", 1e-3},
    KnownUnit{"cm/s", "mps", 1e-2},
    KnownUnit{"in/s", "mps", kInch_m},
    KnownUnit{"m/min", "mps", 1.0 / 60.0},
    KnownUnit{"mm/min", "mps", 1e-3 / 60.0},
    KnownUnit{"rad/s", "radps", 1.0},
    KnownUnit{"radps", "radps", 1.0},
    KnownUnit{"deg/s", "radps", kPi / 180.0},
    KnownUnit{"°/s", "radps", kPi / 180.0},
    KnownUnit{"rpm", "radps", kPi / 30.0},
    KnownUnit{"1/min", "radps", kPi / 30.0},
    KnownUnit{"U/min", "radps", kPi / 30.0},
    KnownUnit{"m/s2", "mps2", 1.0},
    KnownUnit{"m/s^2", "mps2", 1.0},
    KnownUnit{"m/s²", "mps2", 1.0},
    KnownUnit{"Pa", "Pa", 1.0},
    KnownUnit{"hPa", "Pa", 1e2},
    KnownUnit{"kPa", "Pa", 1e3},
    KnownUnit{"MPa", "Pa", 1e6},
    KnownUnit{"mbar", "Pa", 1e2},
    KnownUnit{"bar", "Pa", 1e5},
    KnownUnit{"psi", "Pa", kPsi_Pa},
    KnownUnit{"m3/s", "m3ps", 1.0},
    KnownUnit{"m3ps", "m3ps", 1.0},
    KnownUnit{"m³/s", "m3ps", 1.0},
    KnownUnit{"cm3/s", "m3ps", 1e-6},
    KnownUnit{"l/s", "m3ps", 1e-3},
    KnownUnit{"l/min", "m3ps", kLitrePerMinute_m3ps},
    KnownUnit{"L/min", "m3ps", kLitrePerMinute_m3ps},
    KnownUnit{"lpm", "m3ps", kLitrePerMinute_m3ps},
    KnownUnit{"gpm", "m3ps", kUsGallon_m3 / 60.0},
    KnownUnit{"kg", "kg", 1.0},
    KnownUnit{"Hz", "Hz", 1.0},
    KnownUnit{"kHz", "Hz", 1e3},
    KnownUnit{"-", "1", 1.0},
    KnownUnit{"1", "1", 1.0},
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

const KnownUnit* find_unit(std::string_view text) {
  for (const KnownUnit& unit : kUnits) {
    if (unit.text == text) return &unit;
  }
  // Words and units of several letters in another case, where that names one unit alone.
  if (text.size() < 2) return nullptr;
  const std::string wanted = lower(text);
  const KnownUnit* found = nullptr;
  for (const KnownUnit& unit : kUnits) {
    if (lower(unit.text) != wanted) continue;
    if (found != nullptr && (found->si != unit.si || found->factor != unit.factor)) return nullptr;
    found = &unit;
  }
  // A prefix in another case may be another prefix: "mpa", "mv", "ma" stay unknown.
  const bool prefixed = wanted == "mpa" || wanted == "hpa" || wanted == "mnm" || wanted == "khz";
  return prefixed ? nullptr : found;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// Endings that are words as well: "pressure in", "y_min".
bool is_word_too(std::string_view unit, std::string_view name) {
  if (unit == "min") return true;
  if (unit != "in") return false;
  const std::string stem = folded(name);
  for (const std::string_view length : {"y", "x", "pos", "position", "stroke", "displacement"}) {
    if (stem == length) return false;
  }
  return true;
}

}  // namespace

UnitText parse_unit(std::string_view text) {
  text = trimmed(text);
  for (const std::string_view brackets : {"[]", "()", "{}", "<>"}) {
    if (text.size() >= 2 && text.front() == brackets[0] && text.back() == brackets[1]) {
      text = trimmed(text.substr(1, text.size() - 2));
      break;
    }
  }
  if (text.starts_with("in ") && text.size() > 3) text = trimmed(text.substr(3));
  UnitText unit;
  unit.text = std::string(text);
  std::string plain = unit.text;
  replace_all(plain, "\xCE\xBC", "µ");  // the Greek letter for the micro sign
  if (const KnownUnit* known = find_unit(plain)) {
    unit.si = std::string(known->si);
    unit.factor = known->factor;
  }
  return unit;
}

std::string unit_words(std::string_view si) {
  if (si == "Nm") return "N m";
  if (si == "pct") return "%";
  if (si == "m3ps") return "m3/s";
  if (si == "mps") return "m/s";
  if (si == "mps2") return "m/s2";
  if (si == "radps") return "rad/s";
  return std::string(si);
}

HeaderText parse_header(std::string_view text) {
  const std::string header = clean_text(text);
  const std::string_view whole = trimmed(header);
  const auto split = [&](std::size_t name_end, std::size_t unit_begin, bool only_known) {
    HeaderText result;
    result.name = std::string(trimmed(whole.substr(0, name_end)));
    result.unit = parse_unit(whole.substr(unit_begin));
    const bool good =
        !result.name.empty() && !result.unit.text.empty() && (!only_known || result.unit.known());
    if (!good) result.name.clear();
    return result;
  };
  for (const std::string_view brackets : {"[]", "()", "{}", "<>"}) {
    if (whole.empty() || whole.back() != brackets[1]) continue;
    const std::size_t open = whole.rfind(brackets[0]);
    if (open == std::string_view::npos) continue;
    // "Position (rod)" names no unit, "Position [counts]" an unknown one.
    HeaderText found = split(open, open, brackets[0] != '[');
    if (!found.name.empty()) return found;
  }
  for (const std::string_view between : {" / ", ", ", ",", " in ", " "}) {
    const std::size_t at = whole.rfind(between);
    if (at == std::string_view::npos) continue;
    HeaderText found = split(at, at + between.size(), true);
    // A single letter behind a blank is a letter: "Channel A".
    const bool letter = between == " " && found.unit.text.size() < 2 && found.unit.text != "%";
    const bool word = between == " " && is_word_too(found.unit.text, found.name);
    if (!found.name.empty() && !letter && !word && found.unit.si != "1") return found;
  }
  // The unit may have a stroke of its own: "v/m/s".
  for (std::size_t at = whole.find('/'); at != std::string_view::npos;
       at = whole.find('/', at + 1)) {
    HeaderText found = split(at, at + 1, true);
    if (!found.name.empty()) return found;
  }
  std::string_view stem = whole;
  while (stem.ends_with('_')) stem.remove_suffix(1);
  if (const std::size_t bar = stem.rfind('_'); bar != std::string_view::npos && bar > 0) {
    HeaderText found;
    found.unit = parse_unit(stem.substr(bar + 1));
    std::string_view name = stem.substr(0, bar);
    while (name.ends_with('_')) name.remove_suffix(1);
    const bool word = is_word_too(found.unit.text, name);
    if (found.unit.known() && found.unit.si != "1" && !name.empty() && !word) {
      found.name = std::string(name);
      return found;
    }
  }
  return {std::string(whole), {}};
}

std::string folded(std::string_view name) {
  std::string result;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || std::isalnum(byte) != 0 || c == '%') {
      result += static_cast<char>(std::tolower(byte));
    }
  }
  return result;
}

std::string clean_text(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    text = trimmed(text.substr(1, text.size() - 2));
  }
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20) {
      result += ' ';
    } else if (byte < 0x80) {
      if (text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') ++i;  // "" within quotes
      result += text[i];
    } else {
      const std::size_t more = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : byte >= 0xC2 ? 1 : 0;
      bool utf8 = more > 0 && i + more < text.size();
      for (std::size_t k = 1; utf8 && k <= more; ++k) {
        utf8 = (static_cast<unsigned char>(text[i + k]) & 0xC0U) == 0x80U;
      }
      if (utf8) {
        result.append(text.substr(i, more + 1));
        i += more;
      } else {  // Latin-1: "µ" is one byte there, "°" another
        result += static_cast<char>(0xC0U | (byte >> 6U));
        result += static_cast<char>(0x80U | (byte & 0x3FU));
      }
    }
  }
  return result;
}

}  // namespace config::record
