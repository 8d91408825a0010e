#include "config/record/unit_text.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "config/record/text_fields.h"
#include "config/record/unit_scale.h"

namespace config::record {
namespace {

struct KnownUnit {
  std::string_view spellings;
  std::string_view si;
  double factor;
};

constexpr double kPi = 3.14159265358979323846;
constexpr double kInch_m = 0.0254;
constexpr double kLitrePerMinute_m3ps = 1e-3 / 60.0;
constexpr double kPoundForce_N = 4.4482216152605;
constexpr double kUsGallon_m3 = 3.785411784e-3;

/// Spellings of one unit stand between bars.
constexpr std::array kUnits{
    KnownUnit{"s|sec|secs|second|seconds|Sekunde|Sekunden", "s", 1.0},
    KnownUnit{"ms|msec|millisecond|milliseconds", "s", 1e-3},
    KnownUnit{"us|µs|usec|microseconds", "s", 1e-6},
    KnownUnit{"ns", "s", 1e-9},
    KnownUnit{"min|minutes", "s", 60.0},
    KnownUnit{"h|hr|hour|hours|Stunde|Stunden", "s", 3600.0},
    KnownUnit{"V|Volt|Volts", "V", 1.0},
    KnownUnit{"mV", "V", 1e-3},
    KnownUnit{"A|Amp|Amps|Ampere", "A", 1.0},
    KnownUnit{"mA", "A", 1e-3},
    KnownUnit{"%|pct|percent|Prozent", "pct", 1.0},
    KnownUnit{"N", "N", 1.0},
    KnownUnit{"kN", "N", 1e3},
    KnownUnit{"daN", "N", 10.0},
    KnownUnit{"lbf", "N", kPoundForce_N},
    KnownUnit{"Nm|N m|N*m|N.m|N·m", "Nm", 1.0},
    KnownUnit{"kNm", "Nm", 1e3},
    KnownUnit{"mNm", "Nm", 1e-3},
    KnownUnit{"Ncm", "Nm", 1e-2},
    KnownUnit{"lbf in|lbf*in|lbf·in|lbf-in|in lbf|in-lbf|in·lbf", "Nm", kPoundForce_N* kInch_m},
    KnownUnit{"lbf ft|lbf*ft|lbf·ft|lbf-ft|ft lbf|ft-lbf|ft·lbf", "Nm",
              12.0 * kPoundForce_N* kInch_m},
    KnownUnit{"m|metre|meter|metres|meters", "m", 1.0},
    KnownUnit{"cm", "m", 1e-2},
    KnownUnit{"mm|millimetre|millimeter|millimetres|millimeters", "m", 1e-3},
    KnownUnit{"um|µm", "m", 1e-6},
    KnownUnit{"in|inch|inches|\"|″", "m", kInch_m},
    KnownUnit{"ft", "m", 12.0 * kInch_m},
    KnownUnit{"rad|radian|radians", "rad", 1.0},
    KnownUnit{"mrad", "rad", 1e-3},
    KnownUnit{"deg|degree|degrees|°|Grad", "rad", kPi / 180.0},
    KnownUnit{"rev|revs|revolution|revolutions|Umdrehung|Umdrehungen", "rad", 2.0 * kPi},
    KnownUnit{"m/s|mps", "mps", 1.0},
    KnownUnit{"mm/s|mmps", "mps", 1e-3},
    KnownUnit{"cm/s", "mps", 1e-2},
    KnownUnit{"in/s", "mps", kInch_m},
    KnownUnit{"m/min", "mps", 1.0 / 60.0},
    KnownUnit{"mm/min", "mps", 1e-3 / 60.0},
    KnownUnit{"rad/s|radps", "radps", 1.0},
    KnownUnit{"deg/s|°/s|Grad/s", "radps", kPi / 180.0},
    KnownUnit{"rpm|1/min|U/min", "radps", kPi / 30.0},
    KnownUnit{"m/s2|m/s^2|m/s²", "mps2", 1.0},
    KnownUnit{"Pa", "Pa", 1.0},
    KnownUnit{"hPa|mbar", "Pa", 1e2},
    KnownUnit{"kPa", "Pa", 1e3},
    KnownUnit{"MPa", "Pa", 1e6},
    KnownUnit{"bar", "Pa", 1e5},
    KnownUnit{"psi", "Pa", kPsi_Pa},
    KnownUnit{"m3/s|m3ps|m³/s", "m3ps", 1.0},
    KnownUnit{"cm3/s", "m3ps", 1e-6},
    KnownUnit{"l/s", "m3ps", 1e-3},
    KnownUnit{"l/min|L/min|lpm", "m3ps", kLitrePerMinute_m3ps},
    KnownUnit{"gpm", "m3ps", kUsGallon_m3 / 60.0},
    KnownUnit{"kg", "kg", 1.0},
    KnownUnit{"Hz", "Hz", 1.0},
    KnownUnit{"kHz", "Hz", 1e3},
    KnownUnit{"-|1", "1", 1.0},
};

/// True when `matches` holds for a spelling of the unit.
template <typename Matches>
bool any_spelling(const KnownUnit& unit, const Matches& matches) {
  std::string_view rest = unit.spellings;
  for (std::size_t bar = rest.find('|'); bar != std::string_view::npos; bar = rest.find('|')) {
    if (matches(rest.substr(0, bar))) return true;
    rest.remove_prefix(bar + 1);
  }
  return matches(rest);
}

const KnownUnit* find_unit(std::string_view text) {
  if (text.size() > kMostUnitBytes) return nullptr;
  for (const KnownUnit& unit : kUnits) {
    if (any_spelling(unit, [&](std::string_view spelling) { return spelling == text; })) {
      return &unit;
    }
  }
  // Words and units of several letters in another case, where that names one unit alone.
  if (text.size() < 2) return nullptr;
  const std::string wanted = lower(text);
  const KnownUnit* found = nullptr;
  for (const KnownUnit& unit : kUnits) {
    if (!any_spelling(unit, [&](std::string_view spelling) { return lower(spelling) == wanted; })) {
      continue;
    }
    if (found != nullptr) return nullptr;
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

bool names_time(std::string_view name) {
  const std::string stem = folded(name);
  return stem == "t" || stem == "time" || stem == "zeit" || stem == "elapsed";
}

/// "Winkel" and "phi", before the word that may be their unit.
bool names_angle(std::string_view name) {
  const std::string stem = folded(name);
  if (stem == "y" || stem == "phi") return true;
  constexpr std::array<std::string_view, 7> kWords{"angle", "winkel",   "theta", "position",
                                                   "lage",  "rotation", "dreh"};
  return std::any_of(kWords.begin(), kWords.end(),
                     [&](std::string_view word) { return stem.find(word) != std::string::npos; });
}

/// Endings that are words as well: "pressure in", "y_min", "y_h", "p_grad", "Motor Umdrehungen".
bool is_word_too(std::string_view unit, std::string_view name) {
  if (unit == "min" || unit == "h") return !names_time(name);
  const std::string word = lower(unit);
  if (word.starts_with("umdrehung") || word.starts_with("revolution")) return true;
  if (word == "grad") return !names_angle(name);
  if (unit != "in") return false;
  const std::string stem = folded(name);
  for (const std::string_view length : {"y", "x", "pos", "position", "stroke", "displacement"}) {
    if (stem == length) return false;
  }
  return true;
}

std::string_view without_brackets(std::string_view text) {
  text = trimmed(text);
  for (const std::string_view brackets : {"[]", "()", "{}", "<>"}) {
    if (text.size() >= 2 && text.front() == brackets[0] && text.back() == brackets[1]) {
      return trimmed(text.substr(1, text.size() - 2));
    }
  }
  return text;
}

bool is_unit(std::string_view text) {
  const KnownUnit* const known = find_unit(text);
  return known != nullptr && known->si != "1";
}

}  // namespace

UnitText parse_plain_unit(std::string_view text) {
  text = without_brackets(text);
  if (text.starts_with("in ") && text.size() > 3 && find_unit(text) == nullptr)
    text = trimmed(text.substr(3));
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

UnitText parse_unit(std::string_view text) {
  UnitText unit = parse_plain_unit(text);
  if (unit.known()) return unit;
  std::string plain = with_plain_exponents(unit.text);
  replace_all(plain, "\xCE\xBC", "µ");
  const UnitScale scale = unit_scale(plain);
  if (!is_unit(scale.unit)) return unit;
  const KnownUnit& scaled = *find_unit(scale.unit);
  unit.si = std::string(scaled.si);
  unit.factor = scale.factor * scaled.factor;
  return unit;
}

bool is_scaled_unit(std::string_view text) {
  std::string plain = with_plain_exponents(without_brackets(text));
  replace_all(plain, "\xCE\xBC", "µ");
  return !parse_unit(text).known() && has_open_scale(plain, is_unit);
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

namespace {

/// Parts of a header that has no scale of several readings.
HeaderText split_header(std::string_view whole) {
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
    if (between == " " && !found.name.empty()) {  // "Position 0.1 mm"
      const std::size_t scale = found.name.rfind(' ');
      HeaderText scaled = scale == std::string::npos ? HeaderText{} : split(scale, scale, true);
      if (!scaled.name.empty() && scaled.unit.text.find(' ') != std::string::npos) return scaled;
    }
    // A single letter behind a blank is a letter: "Channel A".
    const bool letter = between == " " && found.unit.text.size() < 2 && found.unit.text != "%";
    const bool word = between == " " && is_word_too(found.unit.text, found.name);
    if (!found.name.empty() && !letter && !word && found.unit.si != "1") return found;
  }
  // The unit may have a stroke of its own: "v/m/s".
  const std::size_t begin = whole.size() - std::min(whole.size(), kMostUnitBytes);
  for (std::size_t at = whole.find('/', begin); at != std::string_view::npos;
       at = whole.find('/', at + 1)) {
    HeaderText found = split(at, at + 1, true);
    // "Flow l/h", "Speed km/h" are rates
    const bool rate = found.unit.si == "s" && !names_time(found.name);
    if (!found.name.empty() && !rate) return found;
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

/// "Position 0.25" and "Position x" of "Position 0.25 mm" and "Position x 0.1 mm".
bool ends_in_scale(std::string_view name) {
  const std::size_t blank = name.rfind(' ');
  if (blank == std::string_view::npos) return name.ends_with('*');
  const std::string_view last = name.substr(blank + 1);
  if (last == "x" || last.ends_with('*') || last == "\xC3\x97") return true;
  double value = 0.0;
  return last.find_first_of(".,") != std::string_view::npos &&
         (parse_number(last, '.', value) || parse_number(last, ',', value));
}

}  // namespace

HeaderText parse_header(std::string_view text) {
  const std::string header = clean_text(text);
  const std::string_view whole = trimmed(header);
  HeaderText found = split_header(whole);
  const bool apart =
      whole.ends_with(']') || whole.ends_with(')') || whole.ends_with('}') || whole.ends_with('>');
  const std::size_t open = apart ? whole.find_last_of("[({<") : std::string_view::npos;
  const bool scaled = (open != std::string_view::npos && is_scaled_unit(whole.substr(open))) ||
                      name_has_scale(with_plain_exponents(found.name)) ||
                      (found.unit.known() && !apart && ends_in_scale(found.name));
  if (scaled) return {std::string(whole), {}, true};
  return found;
}

std::string one_unit_or_map(const std::string& column, const std::string& unit) {
  return "one unit, or the right one in --map: 'KEY=" + column + "[" + unit + "]'";
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

std::string_view cut_text(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) --bytes;
  return text.substr(0, bytes);
}

std::string utf8_text(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t more = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : byte >= 0xC2 ? 1 : 0;
    bool utf8 = byte < 0xF5 && i + more < text.size() && (more > 0 || byte < 0x80);
    for (std::size_t k = 1; utf8 && k <= more; ++k) {
      utf8 = (static_cast<unsigned char>(text[i + k]) & 0xC0U) == 0x80U;
    }
    if (utf8 && more > 1) {  // no overlong form, no surrogate, nothing beyond U+10FFFF
      const auto second = static_cast<unsigned char>(text[i + 1]);
      utf8 = (byte != 0xE0 || second >= 0xA0) && (byte != 0xED || second < 0xA0) &&
             (byte != 0xF0 || second >= 0x90) && (byte != 0xF4 || second < 0x90);
    }
    if (utf8) {
      result.append(text.substr(i, more + 1));
      i += more;
    } else {  // Latin-1: "µ" is one byte there, "°" another
      result += static_cast<char>(0xC0U | (byte >> 6U));
      result += static_cast<char>(0x80U | (byte & 0x3FU));
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
    if (text[i] == '"' && i + 1 < text.size() && text[i + 1] == '"') ++i;  // "" within quotes
    result += static_cast<unsigned char>(text[i]) < 0x20 ? ' ' : text[i];
  }
  return utf8_text(result);
}

}  // namespace config::record
