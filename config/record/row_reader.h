// The numbers of a text file's rows, once its form is known.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/record/text_form.h"
#include "config/record/text_window.h"
#include "config/schema/error.h"

namespace config::record {

/// The refusal of a line that is longer than `window` takes.
[[nodiscard]] schema::DataError too_long(const std::string& place, const TextWindow& window);

/// The rows of a text file, read once from front to back.
class RowReader {
 public:
  enum class Action {
    skip,
    number,
    clock,
    setting  ///< numbers, up to the first cell that is none: the column is left out then
  };

  /// `window` begins with the text.
  RowReader(TextWindow& window, const std::string& name, const TextForm& form,
            std::vector<Action> actions);

  std::vector<std::vector<double>> read();

  [[nodiscard]] bool open_end() const { return open_end_; }

  /// The line of a row.
  [[nodiscard]] std::size_t line_of(std::size_t row) const;

  [[nodiscard]] std::string column_name(std::size_t i) const;

  /// Line of the first cell of a setting that is no number; 0: there is none.
  [[nodiscard]] std::size_t left_out_at(std::size_t i) const { return left_out_at_[i]; }

  /// Line, from 1, and text of the first comment below a row; 0: there is none.
  [[nodiscard]] const std::pair<std::size_t, std::string>& comment() const { return comment_; }

 private:
  void reserve();

  [[nodiscard]] std::string place() const { return name_ + ":" + std::to_string(line_); }

  /// At the beginning of a line: the whole line is in the window then. False at the text's end.
  bool has_line();

  void require_length(const char* line_begin, const char* line_end) const;

  /// Only blank lines follow, to the end of the text; moves the window.
  bool only_blanks_follow(const char* line_end);

  /// Passes comments; false at the end of the rows. An empty line may only end the file.
  bool is_row();

  void read_row();

  void check_row(std::size_t count, const char* row_end, bool cut);

  void skip_blanks();

  /// At the end of a field: passes the separator. False at the line's end.
  bool next_field();

  [[nodiscard]] bool at_field_end() const;

  bool read_field(std::size_t column);

  bool pass_field();

  /// The text up to the field's end, blanks and quotes removed.
  std::string_view take_field();

  double setting_in(std::string_view text, std::size_t column);

  double number_in(std::string_view text, std::size_t column);

  /// The refusal of what stands for a number in `text`.
  [[nodiscard]] schema::DataError no_number(std::string_view text, std::size_t column) const;

  double clock_in(std::string_view text, std::size_t column);

  TextWindow& window_;
  const std::string& name_;
  const TextForm& form_;
  const char separator_;
  std::vector<Action> actions_;
  std::vector<char> has_points_;  ///< not 0: a column of numbers with decimal points
  const char* at_;
  const char* end_;
  const char* row_begin_ = nullptr;
  const char* field_begin_ = nullptr;
  std::size_t line_;
  std::size_t rows_ = 0;
  std::vector<std::vector<double>> values_;
  std::vector<std::size_t> left_out_at_;
  std::vector<std::pair<std::size_t, std::size_t>> passed_;  ///< row, comments before it
  std::pair<std::size_t, std::string> comment_;  ///< line and text of the first below a row
  std::size_t fewest_decimals_ = std::numeric_limits<std::size_t>::max();
  double before_s_ = -std::numeric_limits<double>::infinity();
  double day_s_ = 0.0;
  bool ends_with_newline_;
  bool open_end_ = false;
};

}  // namespace config::record
