#include "config/record/csv_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "config/record/time_grid.h"
#include "config/record/units.h"
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

std::string quoted(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string shown(text.substr(0, kLongest));
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < ' ') c = '?';
  }
  return "'" + shown + (text.size() > kLongest ? "...'" : "'");
}

std::string_view unquoted(std::string_view text) {
  const bool has_quotes = text.size() >= 2 && text.front() == '"' && text.back() == '"';
  return has_quotes ? text.substr(1, text.size() - 2) : text;
}

/// Digits after the decimal point; 0 with an exponent of one digit, such as a cut leaves.
std::size_t decimals(std::string_view number) {
  const std::size_t exponent = number.find_first_of("eE");
  if (exponent != std::string_view::npos) {
    const std::string_view digits = number.substr(number.find_first_not_of("eE+-", exponent));
    if (digits.size() < 2) return 0;
    number = number.substr(0, exponent);
  }
  const std::size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

/// One column on its way in.
struct Target {
  std::string name;  ///< as in the file
  double factor = 1.0;
  std::vector<double>* values = nullptr;
  bool may_be_missing = false;
};

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
    std::vector<Column> columns;
    std::vector<std::string> names;
    std::string_view field;
    while (take(line, ',', field)) {
      field = unquoted(trimmed(field));
      if (field.empty()) throw bad_data(place(1), "has a column without a name");
      names.emplace_back(field);
      columns.push_back(parse_column(field));
    }
    const std::size_t other = names.front().find_first_of(";\t");
    if (names.size() == 1 && other != std::string::npos) {
      throw bad_data(place(1),
                     names.front()[other] == ';' ? "separates columns by semicolons"
                                                 : "separates columns by tabs",
                     "commas, with points in decimal numbers");
    }
    record_.further.reserve(columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      refuse_clash(columns, names, i);
      add_target(columns[i], names[i]);
    }
    require(record_.t_s, "a time column", "t_s, t_ms");
    require(record_.u_V, "a command column", "u_V, u_mV");
    require(record_.y_m, "a position column", "y_m, y_mm");
  }

  void refuse_clash(const std::vector<Column>& columns, const std::vector<std::string>& names,
                    std::size_t i) const {
    for (std::size_t j = 0; j < i; ++j) {
      const std::string both = names[j] + " and " + names[i];
      if (names[i] == names[j]) throw bad_data(place(1), "has column " + names[i] + " twice");
      if (is_time(columns[i]) && is_time(columns[j])) {
        throw bad_data(place(1), "has two time columns, " + both);
      }
      const bool main = columns[i].stem == "u" || columns[i].stem == "y";
      const bool same_stem = columns[i].stem == columns[j].stem && !columns[i].si_unit.empty() &&
                             !columns[j].si_unit.empty();
      if (same_stem && (main || columns[i].si_unit == columns[j].si_unit)) {
        throw bad_data(place(1), "has contradictory units: " + both);
      }
    }
  }

  static bool is_time(const Column& column) { return column.stem == "t" || column.stem == "time"; }

  void add_target(const Column& column, const std::string& name) {
    const auto main_target = [&](std::vector<double>& values, std::string_view unit,
                                 const char* allowed) {
      if (column.si_unit != unit) {
        throw bad_data(place(1),
                       "column " + name +
                           (column.si_unit.empty() ? " has no unit" : " has a contradictory unit"),
                       allowed);
      }
      targets_.push_back({name, column.factor, &values, false});
    };
    if (is_time(column)) {
      main_target(record_.t_s, "s", "t_s, t_ms");
    } else if (column.stem == "u") {
      main_target(record_.u_V, "V", "u_V, u_mV");
    } else if (column.stem == "y") {
      main_target(record_.y_m, "m", "y_m, y_mm, y_um");
    } else {
      record_.further.emplace_back(column.si_name, std::vector<double>{});
      targets_.push_back({name, column.factor, &record_.further.back().second, true});
    }
  }

  void require(const std::vector<double>& values, const char* what, const char* allowed) const {
    for (const Target& target : targets_) {
      if (target.values == &values) return;
    }
    throw bad_data(place(1), std::string("lacks ") + what, allowed);
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
    target.values->push_back(value * target.factor);
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

}  // namespace config::record
