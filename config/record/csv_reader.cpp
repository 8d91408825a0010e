#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

#include "config/record/layout.h"
#include "config/record/readers.h"
#include "config/record/record.h"
#include "config/record/time_grid.h"
#include "config/record/whole_file.h"
#include "config/schema/error.h"

namespace config::record {
namespace {

using schema::bad_data;

constexpr std::string_view kSpaces = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kSpaces);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kSpaces) - begin + 1);
}

/// Takes the text up to `separator` off the front of `rest`; false when nothing was left.
bool take(std::string_view& rest, char separator, std::string_view& part) {
  if (rest.data() == nullptr) return false;
  const std::size_t end = rest.find(separator);
  part = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  return true;
}

std::string_view unquoted(std::string_view text) {
  const bool has_quotes = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return has_quotes ? text.substr(1, text.size() - 2) : text;
}

/// Digits after the decimal point; 0 with an exponent of one digit, such as a cut leaves.
std::size_t decimals(std::string_view number) {
  const std::size_t exponent = number.find_first_of("eE");
  if (exponent != std::string_view::npos) {
    const std::size_t digits = number.find_first_not_of("eE+-", exponent);
    if (digits == std::string_view::npos || number.size() - digits < 2) return 0;
    number = number.substr(0, exponent);
  }
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

class CsvReader {
 public:
  CsvReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {
    record_.name = name;
    ends_with_newline_ = text.ends_with('\n');
  }

  Record read() {
    std::string_view line;
    if (!next_line(line)) throw bad_data(name_, "is empty", "CSV with a header t_s,u_V,y_m");
    read_header(line);
    while (next_line(line)) read_row(line);
    if (record_.t_s.empty()) throw bad_data(name_, "has a header but no data");
    TimeGrid grid = find_grid(record_.t_s, [this](std::size_t i) { return place(i + 2); });
    record_.sample_time_s = grid.sample_time_s;
    record_.gaps = std::move(grid.gaps);
    if (last_without_newline_) {
      record_.notes.emplace_back("the last line has no line end: its last number may be cut off");
    }
    return std::move(record_);
  }

 private:
  [[nodiscard]] std::string place(std::size_t line) const {
    return name_ + ":" + std::to_string(line);
  }

  /// The next line that is not empty; only trailing empty lines are passed over.
  bool next_line(std::string_view& line) {
    while (!rest_.empty()) {
      const bool last = rest_.find('\n') == std::string_view::npos;
      take(rest_, '\n', line);
      ++line_;
      if (!trimmed(line).empty()) {
        last_without_newline_ = last && !ends_with_newline_;
        return true;
      }
      if (trimmed_all(rest_)) return false;
      throw bad_data(place(line_), "is an empty line");
    }
    return false;
  }

  static bool trimmed_all(std::string_view text) {
    return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
  }

  void read_header(std::string_view line) {
    if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    std::vector<std::string> names;
    std::string_view field;
    while (take(line, ',', field)) {
      field = unquoted(trimmed(field));
      if (field.empty()) throw bad_data(place(1), "has a column without a name");
      names.emplace_back(field);
    }
    const std::size_t other = names.front().find_first_of(";\t");
    if (names.size() == 1 && other != std::string::npos) {
      throw bad_data(place(1),
                     names.front()[other] == ';' ? "separates columns by semicolons"
                                                 : "separates columns by tabs",
                     "commas, with points in decimal numbers");
    }
    targets_ = lay_out(names, place(1), record_);
    if (const MissingColumn* missing = first_missing(targets_, record_)) {
      throw bad_data(place(1), std::string("lacks a ") + missing->what + " column",
                     missing->allowed);
    }
  }

  void read_row(std::string_view line) {
    std::size_t count = 0;
    std::string_view field;
    const std::string_view whole = line;
    while (take(line, ',', field)) {
      field = unquoted(trimmed(field));
      if (count < targets_.size()) read_field(field, targets_[count]);
      ++count;
    }
    const std::size_t digits = decimals(field);
    if (count < targets_.size() || (last_without_newline_ && digits < fewest_decimals_)) {
      throw bad_data(place(line_),
                     (last_without_newline_ ? "is cut off: " : "has too few fields: ") +
                         quoted(trimmed(whole)),
                     std::to_string(targets_.size()) + " columns");
    }
    if (count > targets_.size()) {
      throw bad_data(place(line_), "has " + std::to_string(count) + " fields",
                     std::to_string(targets_.size()) + ", as in the header");
    }
    fewest_decimals_ = std::min(fewest_decimals_, digits);
  }

  void read_field(std::string_view text, const Target& target) const {
    double value = std::numeric_limits<double>::quiet_NaN();
    if (!(text.empty() && target.may_be_missing)) {
      std::string_view digits = text;
      if (digits.starts_with('+')) digits.remove_prefix(1);
      const char* end = digits.data() + digits.size();
      const auto result = std::from_chars(digits.data(), end, value);
      if (digits.empty() || result.ec == std::errc::invalid_argument || result.ptr != end) {
        throw bad_data(place(line_), "column " + target.name + ": " + quoted(text) +
                                         (last_without_newline_ ? " is no number, or is cut off"
                                                                : " is no number"));
      }
      const bool missing = std::isnan(value) && target.may_be_missing;
      if (result.ec != std::errc{} || (!std::isfinite(value) && !missing)) {
        throw bad_data(place(line_), "column " + target.name + " is " + quoted(text),
                       "finite numbers");
      }
    }
    value *= target.factor;
    if (std::abs(value) > largest_plausible(target.si_unit)) {
      throw bad_data(place(line_), "column " + target.name + " is " + quoted(text),
                     plausible_range(target.si_unit));
    }
    target.values->push_back(value);
  }

  std::string_view rest_;
  const std::string& name_;
  Record record_;
  std::vector<Target> targets_;
  std::size_t line_ = 0;
  std::size_t fewest_decimals_ = std::numeric_limits<std::size_t>::max();
  bool ends_with_newline_ = false;
  bool last_without_newline_ = false;
};

}  // namespace

Record read_csv(std::string_view text, const std::string& name) {
  return CsvReader(text, name).read();
}

namespace {

void append(std::string& text, double value) {
  if (std::isnan(value)) return;  // a missing value is an empty field
  char buffer[32];
  const auto result = std::to_chars(std::begin(buffer), std::end(buffer), value);
  text.append(std::begin(buffer), result.ptr);
}

std::string csv_text(const Record& record) {
  std::string text = "t_s,u_V,y_m";
  for (const auto& [name, values] : record.further) text += "," + name;
  text += '\n';
  for (std::size_t i = 0; i < record.size(); ++i) {
    append(text, record.t_s[i]);
    text += ',';
    append(text, record.u_V[i]);
    text += ',';
    append(text, record.y_m[i]);
    for (const auto& [name, values] : record.further) {
      text += ',';
      append(text, values[i]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

void write_csv(const Record& record, const std::filesystem::path& file) {
  write_whole(file, csv_text(record));
}

}  // namespace config::record
