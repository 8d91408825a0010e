// A text that is read once, from front to back, through a window on some of its lines: a file of
// any size needs no more memory than that, and a read that fails is an error like any other.
//
// [begin(), end()) are whole lines; the last one of the text may lack its end. refill() goes on to
// the lines behind them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace config::record {

class TextWindow {
 public:
  struct Sizes {
    std::size_t piece_bytes = std::size_t{256} << 10U;  ///< read at a time
    std::size_t most_bytes = std::size_t{16} << 20U;    ///< up to which extend() goes
    std::size_t longest_line_bytes = std::size_t{1} << 20U;
  };

  /// A text in memory, which must outlive the window; all of it is in the window.
  explicit TextWindow(std::string_view text) noexcept;
  /// A regular file, read up to the size that it has now. Throws schema::DataError, here and in
  /// extend() and refill(), when a read fails or the file has become shorter.
  TextWindow(const std::filesystem::path& file, Sizes sizes);
  ~TextWindow();
  TextWindow(const TextWindow&) = delete;
  TextWindow& operator=(const TextWindow&) = delete;

  [[nodiscard]] const char* begin() const noexcept { return begin_; }
  /// begin() before the text's end: the next line is longer than a line may be.
  [[nodiscard]] const char* end() const noexcept { return end_; }
  [[nodiscard]] std::string_view text() const noexcept {
    return {begin_, static_cast<std::size_t>(end_ - begin_)};
  }
  /// True when the text ends with the window.
  [[nodiscard]] bool last() const noexcept { return to_come_ == 0; }
  /// Bytes of the text from `at`, a position in the window, to its end.
  [[nodiscard]] std::size_t bytes_from(const char* at) const noexcept {
    return static_cast<std::size_t>(read_ - at) + to_come_;
  }
  /// True when the whole text ends with a newline.
  [[nodiscard]] bool ends_with_newline() const noexcept { return ends_with_newline_; }
  [[nodiscard]] std::size_t longest_line() const noexcept { return sizes_.longest_line_bytes; }

  /// Adds lines; false at the text's end or at the size that a window may have. Pointers into the
  /// window are invalid then.
  bool extend();
  /// Goes on to the lines behind the window. Pointers into it are invalid then.
  void refill();

 private:
  void take_last_byte();
  /// Reads another piece behind the `held` bytes at the buffer's front.
  void read_piece(std::size_t held);

  Sizes sizes_;
  std::string name_;
  int file_ = -1;
  std::size_t to_come_ = 0;  ///< bytes of the file that are not read yet
  std::vector<char> buffer_;
  const char* begin_ = nullptr;
  const char* end_ = nullptr;
  const char* read_ = nullptr;  ///< end of the bytes read, within the line behind the window
  bool ends_with_newline_ = false;
};

}  // namespace config::record
