// A file that is written piece by piece and has its name only once it is complete: until then it is
// FILE.part beside it, where one that was cut off can still be found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace config::record {

class GrowingFile {
 public:
  /// A link is followed, a device or a pipe is written to as it is. A FILE.part that was cut off
  /// before is kept under another name. Throws schema::RunError when the file cannot be made, or
  /// while another process writes it.
  explicit GrowingFile(const std::filesystem::path& file);
  /// Leaves an unfinished file as FILE.part.
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  /// Texts are written whole: one that does not fit leaves no half. Throws schema::RunError.
  void append(std::string_view text);
  /// File and name are on the disk when it returns; one that is replaced leaves its permissions.
  /// Throws schema::RunError.
  void finish();
  /// Leaves nothing.
  void discard();

  /// The name of an earlier FILE.part; empty: there was none.
  [[nodiscard]] const std::filesystem::path& kept() const noexcept { return kept_; }

 private:
  /// False where another process has taken or finished it meanwhile.
  bool open_part();
  void keep_earlier();
  void flush();
  [[noreturn]] void fail(int error) const;

  std::filesystem::path file_, target_, part_, kept_;
  bool special_;
  int out_ = -1;
  std::int64_t written_ = 0;  ///< bytes
  std::string waiting_;
};

}  // namespace config::record
