#include "config/record/unit_line.h"

#include <algorithm>
#include <array>

#include "config/record/text_fields.h"
#include "config/record/unit_text.h"

namespace config::record {

namespace {

/// Longest text of an unknown unit, in bytes: "degC", "um/m2".
constexpr std::size_t kLongestUnit = 8;

/// True for a text that may be a unit that is not known: a short word without a digit in front.
bool may_be_unit(const std::string& field) {
  return field.size() <= kLongestUnit && !is_digit(field.front()) &&
         field.find_first_of(" \t.,:;=\"'+") == std::string::npos;
}

}  // namespace

bool leads_units(std::string_view field) {
  constexpr std::array<std::string_view, 12> kWords{
      "unit",   "units", "einheit",         "einheiten",        "unite", "unites",
      "unidad", "unita", "engineeringunit", "engineeringunits", "eu",    "dimension"};
  return std::find(kWords.begin(), kWords.end(), folded(field)) != kWords.end();
}

bool is_unit_line(const std::vector<std::string>& fields) {
  std::size_t known = 0;
  std::size_t unknown = 0;
  for (const std::string& field : fields) {
    if (&field == &fields.front() && leads_units(field)) continue;
    if (is_scaled_unit(field)) {
      ++known;
      continue;
    }
    if (field.empty() || field == "-" || field == "[]" || field == "[-]" || field == "()") continue;
    const UnitText unit = parse_unit(field);
    if (!unit.known()) {
      const bool bracketed = field.front() == '[' || field.front() == '(';
      if (!bracketed && !may_be_unit(field)) return false;
      unknown += bracketed ? 0 : 1;
      continue;
    }
    ++known;
  }
  // names of one letter are no line of units: "t", "V", "pump"
  return known > 0 && (unknown == 0 || known > unknown + 1);
}

}  // namespace config::record
