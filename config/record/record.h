// A recorded experiment (u, y) in SI units, read from CSV, a MAT file or an LCM event log.
//
// CSV: one header line whose names end in their unit (t_s, u_V, y_mm, ...); time, command and
// position are found by their stem (t, u, y); any further column is kept under its name in SI
// units (ref_mm becomes ref_m). MAT: vectors of these names. LCM: the sample_t
// messages of one channel; the time is tick times sample time, and the further columns are the
// other fields of the message and what is told beside it (sample_columns.h). Samples of stale or
// bad quality, or without a command, are left out like any missing sample.
//
// Row k: y is sampled at t[k], before u[k] is written; u[k] holds until t[k+1].
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace config::record {

struct Record {
  std::string name;            ///< the file it came from, for messages
  double sample_time_s = 0.0;  ///< median step of t_s
  std::vector<double> t_s;
  std::vector<double> u_V;
  std::vector<double> y_m;
  /// Further columns in file order, names with their SI unit suffix, same length as t_s. Here, and
  /// only here, NaN stands for a missing value.
  std::vector<std::pair<std::string, std::vector<double>>> further;
  std::vector<std::size_t> gaps;   ///< index of the first sample after each gap, ascending
  std::vector<std::string> notes;  ///< remarks for results: samples left out, ...

  [[nodiscard]] std::size_t size() const noexcept { return t_s.size(); }
  /// The further column of that name, null when there is none.
  [[nodiscard]] const std::vector<double>* column(std::string_view name) const noexcept;
};

/// The LCM channel that a record is read from when none is named.
inline constexpr std::string_view kSampleChannel = "SPOOLWATCH_SAMPLE";

/// Reads CSV, MAT or an LCM event log, told apart by content. Throws schema::DataError (one
/// line, "file:line: what; allowed: ...") for bad data. A step in time of a whole number of periods
/// is a gap (listed); any other uneven step is an error.
[[nodiscard]] Record read_record(const std::filesystem::path& file,
                                 std::string_view channel = kSampleChannel);

/// Writes t_s,u_V,y_m and the further columns; shortest decimal text that reads back exactly. The
/// file appears complete or not at all (temporary name, rename). Throws schema::RunError.
void write_csv(const Record& record, const std::filesystem::path& file);

}  // namespace config::record
