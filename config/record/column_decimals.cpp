#include "config/record/column_decimals.h"

#include <cmath>

namespace config::record {
namespace {

struct NumberReadings {
  explicit NumberReadings(const std::string& field) {
    const bool by_point = parse_number(field, '.', point);
    const bool thousands = by_point || parse_number(field, '.', point, LoneGroup::thousands);
    const bool by_comma = parse_number(field, ',', comma);
    shows_point = by_point && field.find_first_of(".,") != std::string::npos;
    shows_comma = !thousands && by_comma;
    either = thousands && !by_point && by_comma;
  }
  double point = std::nan(""), comma = std::nan("");
  bool shows_point = false, shows_comma = false, either = false;
};

}  // namespace

bool ColumnReading::allows(const std::string& field, FieldKind kind) const {
  if (kind != FieldKind::number) return true;
  const NumberReadings now(field);
  return !((shows_point_ || now.shows_point) && (shows_comma_ || now.shows_comma));
}

void ColumnReading::take(const std::string& field, FieldKind kind) {
  NumberReadings now(field);
  if (kind != FieldKind::number) now = NumberReadings("");
  shows_point_ = shows_point_ || now.shows_point;
  shows_comma_ = shows_comma_ || now.shows_comma;
  if (now.either && either_.empty()) either_ = field;
  if (head_.size() < kHeadRows) head_.emplace_back(now.point, now.comma);
}

ColumnDecimals ColumnReading::decimals(char others) const {
  if (shows_comma_) return {',', LoneGroup::refused, ""};
  if (shows_point_ || either_.empty()) {
    return {'.', shows_point_ ? LoneGroup::thousands : LoneGroup::refused, ""};
  }
  if (others == ',') return {',', LoneGroup::refused, ""};
  if (others == '.') return {'.', LoneGroup::thousands, ""};
  return {'.', LoneGroup::refused, either_};
}

std::vector<double> ColumnReading::head(char decimal) const {
  std::vector<double> values;
  values.reserve(head_.size());
  for (const auto& [point, comma] : head_) values.push_back(decimal == ',' ? comma : point);
  return values;
}

}  // namespace config::record
