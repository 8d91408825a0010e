#include "config/record/unit_line.h"

#include "config/record/unit_text.h"

namespace config::record {

bool is_unit_line(const std::vector<std::string>& fields) {
  std::size_t known = 0;
  for (const std::string& field : fields) {
    if (field.empty() || field == "-" || field == "[]" || field == "[-]" || field == "()") continue;
    const UnitText unit = parse_unit(field);
    if (!unit.known()) {
      const bool bracketed = field.front() == '[' || field.front() == '(';
      if (!bracketed) return false;
      continue;
    }
    ++known;
  }
  return known > 0;
}

}  // namespace config::record
