#include "config/record/missing_marks.h"

#include <algorithm>
#include <cmath>

namespace config::record {
namespace {

bool is_mark(double value, double m_per_unit) {
  constexpr double kRounding = 1e-9;
  for (const double mark : {999.0, 9999.0, 99999.0}) {
    for (const double marks_per_unit : {1.0, m_per_unit, 1e3 * m_per_unit}) {
      if (std::abs(std::abs(value * marks_per_unit) - mark) <= kRounding * mark) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<std::size_t> find_missing_marks(const std::vector<double>& values, double m_per_unit) {
  constexpr double kFarOff = 0.1;  // greatest magnitude that is no mark, in marks
  std::vector<std::size_t> marks;
  double greatest = -1.0;  // magnitude that is no mark; negative: there is none
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (is_mark(values[row], m_per_unit)) {
      marks.push_back(row);
    } else if (!std::isnan(values[row])) {
      greatest = std::max(greatest, std::abs(values[row]));
    }
  }
  std::erase_if(marks, [&](std::size_t row) {
    return greatest < 0.0 || greatest >= kFarOff * std::abs(values[row]);
  });
  return marks;
}

}  // namespace config::record
