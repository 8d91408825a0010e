// A recorded experiment (u, y) in SI units, read from text, a MAT file or an LCM event log.
//
// Text (CSV and its relatives): one header line whose names end in their unit (t_s, u_V, y_mm,
// ...); time, command and position are found by their stem (t, u, y); any further column is kept
// under its name in SI units (ref_mm becomes ref_m). Other headers are read by their words and
// units, or as a mapping says (reading.h, column_roles.h). MAT: vectors of such names. LCM: the
// sample_t messages of one channel; the time is tick times sample time, and the further columns are
// the other fields of the message and the messages beside it (sample_columns.h). Samples of stale
// or bad quality, or without a command, are left out like any missing sample.
//
// Row k: y is sampled at t[k], before u[k] is written; u[k] holds until t[k+1].
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/record/reading.h"

namespace config::record {

/// Where the values of a channel came from.
struct ChannelOrigin {
  std::string name;        ///< in the record: "t_s", "u_A", "supply_Pa"
  std::string header;      ///< in the file; empty: it has none
  std::size_t column = 0;  ///< number in the file, from 1; 0: made, not read
  std::string unit;        ///< in the file; empty: none
  double factor = 1.0;     ///< value = factor * number in the file + offset
  double offset = 0.0;
  std::size_t missing = 0;  ///< rows without a number
};

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
  std::string left_out;            ///< those of `notes` that say why samples are missing
  /// Units of u_V and y_m where they are no volts and metres, as endings of names: "A", "pct", "N",
  /// "rad", ... Every V or m of a result then stands for one of these.
  std::string command_unit = "V";
  std::string position_unit = "m";
  bool command_is_interpolated = false;  ///< shifted by a part of a sample (command_advance.h)
  bool has_position = true;              ///< false: y_m is 0, the file has a command alone
  std::vector<ChannelOrigin> origins;    ///< one per channel that was read, in the file's order
  std::string form;                      ///< the file's form in words; empty: as write_csv writes

  [[nodiscard]] std::size_t size() const noexcept { return t_s.size(); }
  /// The further column of that name, null when there is none.
  [[nodiscard]] const std::vector<double>* column(std::string_view name) const noexcept;
};

/// The LCM channel that a record is read from when none is named.
inline constexpr std::string_view kSampleChannel = "SPOOLWATCH_SAMPLE";

struct MatVariable;

/// Reads the variables of an HDF5 file (hdf5/hdf5_variables.h).
using Hdf5Reader = std::vector<MatVariable> (*)(const std::string& file);
/// Lets read_record read HDF5, MATLAB's version 7.3 among it; once, before any thread reads. The
/// daemon does without, and without the library.
void set_hdf5_reader(Hdf5Reader reader) noexcept;

/// Reads text, MAT or an LCM event log, told apart by content. Throws schema::DataError (one
/// line, "file:line: what; allowed: ...") for bad data. A step in time of a whole number of periods
/// is a gap (listed), and so are rows without time, command or position; any other uneven step is
/// an error, unless the times are those of an even grid, rounded or with jitter.
[[nodiscard]] Record read_record(const std::filesystem::path& file,
                                 const ReadOptions& options = {});

struct RecordUnits {
  std::string name;  ///< the record's
  std::string command;
  std::string position;
};
[[nodiscard]] RecordUnits units_of(const Record& record);
/// Throws schema::DataError where two records differ: no model can describe both.
void require_same_units(const std::vector<RecordUnits>& records);

/// Throws schema::DataError for a record whose command is not in V or whose position is not in m.
void require_volts_and_metres(const Record& record);

/// Writes t_s, u_V, y_m (with their units) and the further columns; shortest decimal text that
/// reads back exactly. The file appears complete or not at all (temporary name, rename). Throws
/// schema::RunError.
void write_csv(const Record& record, const std::filesystem::path& file);

}  // namespace config::record
