#include "config/record/row_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "config/record/clock_text.h"
#include "config/record/layout.h"
#include "config/record/text_fields.h"
#include "config/record/unit_cells.h"

namespace config::record {
namespace {

using schema::bad_data;

/// Digits after the decimal sign; 0 with an exponent of one digit, such as a cut leaves.
std::size_t decimals(std::string_view number, char decimal) {
  const std::size_t exponent = number.find_first_of("eE");
  if (exponent != std::string_view::npos) {
    const std::size_t digits = number.find_first_of("0123456789", exponent);
    if (digits == std::string_view::npos || number.size() - digits < 2) return 0;
    number = number.substr(0, exponent);
  }
  const std::size_t point = number.find(decimal);
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

}  // namespace

schema::DataError too_long(const std::string& place, const TextWindow& window) {
  return bad_data(place, "is longer than a line may be",
                  std::to_string(window.longest_line()) + " bytes");
}

RowReader::RowReader(TextWindow& window, const std::string& name, const TextForm& form,
                     std::vector<Action> actions)
    : window_(window),
      name_(name),
      form_(form),
      separator_(form.dialect.separator),
      actions_(std::move(actions)),
      at_(window.begin() + form.data_offset),
      end_(window.end()),
      line_(form.data_line),
      ends_with_newline_(window.ends_with_newline()) {
  values_.resize(actions_.size());
  left_out_at_.resize(actions_.size());
  for (std::size_t i = 0; i < actions_.size(); ++i) {
    const bool points = form.decimals[i].decimal == '.' && !form.cell_units[i].any();
    has_points_.push_back(actions_[i] == Action::number && points ? 1 : 0);
  }
  reserve();
}

std::vector<std::vector<double>> RowReader::read() {
  while (has_line() && is_row()) read_row();
  if (rows_ == 0) throw bad_data(name_, "has a header but no data");
  return std::move(values_);
}

std::size_t RowReader::line_of(std::size_t row) const {
  std::size_t line = form_.data_line + row;
  for (const auto& [from, count] : passed_) {
    if (from <= row) line += count;
  }
  return line;
}

std::string RowReader::column_name(std::size_t i) const {
  return form_.names.empty() || form_.names[i].empty() ? std::to_string(i + 1) : form_.names[i];
}

void RowReader::reserve() {
  const char* at = at_;
  std::size_t lines = 0;
  while (lines < 100 && at < end_) {
    const char* const next = std::find(at, end_, '\n');
    ++lines;
    at = next == end_ ? end_ : next + 1;
  }
  if (lines == 0) return;
  const double bytes_a_line = static_cast<double>(at - at_) / static_cast<double>(lines);
  const auto rows = static_cast<std::size_t>(
      1.01 * static_cast<double>(window_.bytes_from(at_)) / std::max(2.0, bytes_a_line) + 16.0);
  for (std::size_t i = 0; i < actions_.size(); ++i) {
    if (actions_[i] != Action::skip) values_[i].reserve(rows);
  }
}

// Inline, as they run for each field: read() alone calls them.

inline bool RowReader::has_line() {
  if (at_ < end_) return true;
  if (window_.last()) return false;
  window_.refill();
  at_ = window_.begin();
  end_ = window_.end();
  if (at_ == end_) throw too_long(place(), window_);
  return true;
}

inline void RowReader::require_length(const char* line_begin, const char* line_end) const {
  if (static_cast<std::size_t>(line_end - line_begin) <= window_.longest_line()) return;
  throw too_long(place(), window_);
}

bool RowReader::only_blanks_follow(const char* line_end) {
  at_ = line_end;
  do {
    at_ = std::find_if(at_, end_, [](char c) { return !is_blank(c) && c != '\n'; });
    if (at_ < end_) return false;
  } while (has_line());
  return true;
}

inline bool RowReader::is_row() {
  do {
    const char* first = at_;
    while (first < end_ && is_blank(*first) && *first != separator_) ++first;
    if (first < end_ && *first != '\n' && *first != '#' && *first != '%' && *first != 'E') {
      return true;
    }
    const char* const line_end = std::find(first, end_, '\n');
    require_length(at_, line_end);
    if (first == end_) return false;
    const std::string_view line = trimmed({first, static_cast<std::size_t>(line_end - first)});
    if (line.empty() || line == "EOF") {
      const bool empty = line.empty();
      if (only_blanks_follow(line_end)) return false;
      throw bad_data(place(), empty ? "is an empty line" : "is EOF, but rows follow");
    }
    if (line.front() == 'E') return true;
    passed_.emplace_back(rows_, 1);
    if (rows_ > 0 && comment_.first == 0) comment_ = {line_, std::string(line)};
    ++line_;
    at_ = line_end == end_ ? end_ : line_end + 1;
  } while (has_line());
  return false;
}

inline void RowReader::read_row() {
  row_begin_ = at_;
  std::size_t count = 0;
  const std::size_t columns = actions_.size();
  if (separator_ == ' ') skip_blanks();
  while (true) {
    field_begin_ = at_;
    const bool more = count < columns ? read_field(count) : pass_field();
    ++count;
    if (!more) break;
  }
  const char* const row_end = at_;
  require_length(row_begin_, row_end);
  const bool cut = at_ >= end_ && !ends_with_newline_;
  open_end_ = cut;
  if (at_ < end_) ++at_;  // the line's end
  if (count != columns || !ends_with_newline_) check_row(count, row_end, cut);
  ++rows_;
  ++line_;
}

void RowReader::check_row(std::size_t count, const char* row_end, bool cut) {
  const std::size_t columns = actions_.size();
  const std::string_view last =
      trimmed({field_begin_, static_cast<std::size_t>(row_end - field_begin_)});
  const std::size_t digits = decimals(last, form_.decimals.back().decimal);
  if (count < columns || (cut && digits < fewest_decimals_ && rows_ > 0)) {
    throw bad_data(
        place(),
        (cut ? "is cut off: " : "has too few fields: ") +
            quoted(trimmed({row_begin_, static_cast<std::size_t>(row_end - row_begin_)})),
        std::to_string(columns) + " columns");
  }
  if (count > columns) {
    const bool twice = separator_ == ',' && count == 2 * columns;
    throw bad_data(place(), "has " + std::to_string(count) + " fields",
                   std::to_string(columns) +
                       (form_.names.empty() ? ", as in the rows before" : ", as in the header") +
                       (twice ? "; decimal commas need another separator" : ""));
  }
  fewest_decimals_ = std::min(fewest_decimals_, digits);
}

inline void RowReader::skip_blanks() {
  while (at_ < end_ && is_blank(*at_) && *at_ != separator_) ++at_;
  if (separator_ == ' ') {
    while (at_ < end_ && is_blank(*at_)) ++at_;
  }
}

inline bool RowReader::next_field() {
  if (at_ >= end_ || *at_ == '\n') return false;
  if (separator_ != ' ') {
    ++at_;
    return true;
  }
  skip_blanks();
  return at_ < end_ && *at_ != '\n';
}

inline bool RowReader::at_field_end() const {
  return at_ >= end_ || *at_ == '\n' || *at_ == separator_ || (separator_ == ' ' && is_blank(*at_));
}

inline bool RowReader::read_field(std::size_t column) {
  const Action action = actions_[column];
  if (action == Action::skip) return pass_field();
  if (has_points_[column] != 0) {
    if (separator_ != ' ') {
      while (at_ < end_ && *at_ == ' ') ++at_;
    }
    double value = 0.0;
    const auto result = std::from_chars(at_, end_, value);
    if (result.ec == std::errc{} && std::isfinite(value)) {
      at_ = result.ptr;
      if (separator_ != ' ') {
        while (at_ < end_ && is_blank(*at_) && *at_ != separator_) ++at_;
      }
      if (at_field_end()) {
        values_[column].push_back(value);
        return next_field();
      }
    }
    at_ = field_begin_;
  }
  const std::string_view text = take_field();
  values_[column].push_back(action == Action::clock     ? clock_in(text, column)
                            : action == Action::setting ? setting_in(text, column)
                                                        : number_in(text, column));
  return next_field();
}

inline bool RowReader::pass_field() {
  (void)take_field();
  return next_field();
}

inline std::string_view RowReader::take_field() {
  skip_blanks();
  const char* from = at_;
  if (at_ < end_ && *at_ == '"') {
    const char* close = at_ + 1;
    while (close < end_ && *close != '\n' &&
           !(*close == '"' && (close + 1 == end_ || close[1] != '"'))) {
      close += *close == '"' ? 2 : 1;
    }
    if (close < end_ && *close == '"') {
      from = at_ + 1;
      at_ = close + 1;
      while (!at_field_end()) ++at_;
      return trimmed({from, static_cast<std::size_t>(close - from)});
    }
  }
  while (!at_field_end()) ++at_;
  return trimmed({from, static_cast<std::size_t>(at_ - from)});
}

inline double RowReader::number_in(std::string_view text, std::size_t column) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (is_missing(text)) return value;
  const ColumnDecimals& written = form_.decimals[column];
  const std::optional<std::string_view> number = form_.cell_units[column].number_in(text);
  if (!number || !parse_number(*number, written.decimal, value, written.lone)) {
    if (is_missing_cell(text)) return std::numeric_limits<double>::quiet_NaN();
    const std::string word = lower(text);
    const bool infinite = word == "inf" || word == "-inf" || word == "+inf" || word == "infinity" ||
                          word == "-infinity";
    if (!infinite) throw no_number(text, column);
    value = std::numeric_limits<double>::infinity();
  }
  if (!std::isfinite(value)) {
    throw bad_data(place(), "column " + column_name(column) + " is " + quoted(text),
                   "finite numbers");
  }
  return value;
}

double RowReader::setting_in(std::string_view text, std::size_t column) {
  try {
    return number_in(text, column);
  } catch (const schema::DataError&) {
    if (unit_cell(text)) throw;  // a number in another unit is no word
    left_out_at_[column] = line_;
    actions_[column] = Action::skip;
    return std::numeric_limits<double>::quiet_NaN();
  }
}

schema::DataError RowReader::no_number(std::string_view text, std::size_t column) const {
  const std::string begin = "column " + column_name(column) + ": ";
  const ColumnDecimals& written = form_.decimals[column];
  const bool cut = at_ >= end_ && !ends_with_newline_;
  const std::string_view number = without_unit(text);
  double value = 0.0;
  if (cut) return bad_data(place(), begin + quoted(text) + " is no number, or is cut off");
  if (!parse_number(number, written.decimal, value, LoneGroup::thousands)) {
    return bad_data(place(), begin + quoted(text) + " is no number");
  }
  if (!parse_number(number, written.decimal, value, written.lone)) {
    return bad_data(place(), begin + quoted(text) + " has two readings", kOneReading);
  }
  return bad_data(place(), begin + form_.cell_units[column].conflict(text), kOneUnit);
}

double RowReader::clock_in(std::string_view text, std::size_t column) {
  double time_s = std::numeric_limits<double>::quiet_NaN();
  if (is_missing(text)) return time_s;
  if (!parse_clock(text, time_s)) {
    throw bad_data(place(),
                   "column " + column_name(column) + ": " + quoted(text) + " is no date and time");
  }
  constexpr double kDay_s = 86400.0;
  // Times of day begin again at midnight.
  if (time_s < kDay_s && time_s + day_s_ < before_s_ - 0.5 * kDay_s) day_s_ += kDay_s;
  if (time_s < kDay_s) time_s += day_s_;
  before_s_ = time_s;
  return time_s;
}

}  // namespace config::record
