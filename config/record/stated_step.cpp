#include "config/record/stated_step.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "config/record/text_fields.h"
#include "config/record/unit_cells.h"
#include "config/record/unit_text.h"

namespace config::record {
namespace {

enum class Stated { nothing, period, rate };

Stated stated_by(const std::string& name) {
  constexpr std::array<std::string_view, 14> kPeriods{"dt",
                                                      "deltat",
                                                      "increment",
                                                      "xincrement",
                                                      "timeincrement",
                                                      "sampletime",
                                                      "sampleinterval",
                                                      "samplingtime",
                                                      "samplinginterval",
                                                      "sampleperiod",
                                                      "samplingperiod",
                                                      "abtastzeit",
                                                      "abtastintervall",
                                                      "interval"};
  constexpr std::array<std::string_view, 8> kRates{
      "samplerate", "samplingrate",   "samplefrequency", "samplingfrequency",
      "abtastrate", "abtastfrequenz", "messrate",        "rate"};
  const std::string word = folded(name);
  if (std::find(kPeriods.begin(), kPeriods.end(), word) != kPeriods.end()) return Stated::period;
  return std::find(kRates.begin(), kRates.end(), word) != kRates.end() ? Stated::rate
                                                                       : Stated::nothing;
}

/// The period in "0.005", "5 ms" or "200 Hz"; `unit`: that of the name. 0: none.
double step_in(std::string_view field, Stated stated, UnitText unit, char decimal) {
  field = trimmed(field);
  const std::optional<UnitCell> cell = unit_cell(field);
  if (cell) unit = cell->unit;
  double value = 0.0;
  if (!parse_number(cell ? cell->number : field, decimal, value) || !(value > 0.0)) return 0.0;
  if (unit.si == "Hz" || (unit.text.empty() && stated == Stated::rate)) {
    return 1.0 / (value * unit.factor);
  }
  return unit.si == "s" || unit.text.empty() ? value * unit.factor : 0.0;
}

}  // namespace

double stated_step_s(const std::vector<TextLine>& lines, std::size_t end,
                     const TextDialect& dialect) {
  std::vector<std::string> above;
  for (std::size_t i = 0; i < std::min(end, lines.size()); ++i) {
    std::vector<std::string> fields = split_fields(lines[i].text, dialect.separator);
    // "dt: 0.005" in one field
    const std::size_t mark = fields[0].find_first_of(":=");
    if (mark != std::string::npos && mark + 1 < fields[0].size()) {
      fields.insert(fields.begin() + 1, fields[0].substr(mark + 1));
      fields[0].resize(mark);
    }
    for (std::size_t c = 0; c < fields.size(); ++c) {
      const auto read = [&](std::string name) {
        while (!name.empty() && (name.back() == ':' || name.back() == '=')) name.pop_back();
        const HeaderText text = parse_header(name);
        const Stated stated = stated_by(text.name);
        return stated == Stated::nothing ? 0.0
                                         : step_in(fields[c], stated, text.unit, dialect.decimal);
      };
      if (const double left = c > 0 ? read(fields[c - 1]) : 0.0; left > 0.0) return left;
      if (const double upper = c < above.size() ? read(above[c]) : 0.0; upper > 0.0) return upper;
    }
    above = std::move(fields);
  }
  return 0.0;
}

}  // namespace config::record
