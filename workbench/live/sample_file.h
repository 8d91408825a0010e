// Samples as they arrive, row by row into a CSV record (config/record/record.h) that has its name
// only once it is complete.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "config/record/growing_file.h"
#include "config/record/sample_columns.h"

namespace spoolwatch {
class sample_t;
}

namespace workbench::live {

class SampleFile {
 public:
  /// Throws config::schema::RunError when it cannot be made.
  explicit SampleFile(const std::string& file) : out_(file) {}

  /// Takes what comes just before its sample. Columns of what comes only after the first row are
  /// left out.
  template <class Message>
  void note(const Message& beside) {
    columns_.note(beside);
  }
  /// Ticks ascend. A sample without a good position and command gives no row: a gap.
  void add(const spoolwatch::sample_t& sample);
  /// Gives the file its name; without a row there is no file. Throws config::schema::RunError.
  void finish();

  [[nodiscard]] std::int64_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::int64_t unusable() const noexcept { return unusable_; }
  [[nodiscard]] std::int64_t gaps() const noexcept { return gaps_; }
  /// Periods without a row between the first and the last.
  [[nodiscard]] std::int64_t missing() const noexcept { return missing_; }
  [[nodiscard]] double duration_s() const noexcept;

  /// An earlier record of that name that was cut off, if there was one.
  [[nodiscard]] const std::filesystem::path& kept() const noexcept { return out_.kept(); }

 private:
  config::record::GrowingFile out_;
  config::record::SampleColumns columns_;
  std::size_t width_ = 0;  ///< further columns
  std::string row_;
  std::int64_t rows_ = 0, unusable_ = 0, gaps_ = 0, missing_ = 0;
  std::int64_t first_tick_ = 0, last_tick_ = 0;
  double sample_time_s_ = 0.0;
};

}  // namespace workbench::live
