// A log or record as a MAT file, CSV, JSON or MCAP.
#pragma once

#include <string>

#include "workbench/exchange/source.h"

namespace workbench::exchange {

///   t_s, u_V, y_m, reference_m, ...           columns of the samples: a record that reads back
///   estimates.SOURCE.t_s, .valid              columns, one row for each message
///   estimates.SOURCE.NAME.value, .std_error, .low, .high
///   alarms(k).t_s, .source, .name, .active    one structure for each message
///   health.t_s, .overruns, ...                columns
///
/// t_s is tick times sample time, or counts from the first message where there are no samples.
[[nodiscard]] std::string mat_file(const std::string& input, const Kinds& kinds,
                                   const config::record::ReadOptions& reading = {});

/// `record` by the ending of `file`: .csv, .mat, .h5 or .hdf5. Throws config::schema::UsageError,
/// which names `option`, for another one.
void write_record_file(const config::record::Record& record, const std::string& file,
                       const std::string& option);

/// CSV: one kind of message at a time, for it is one table.
/// Samples become a record (t_s,u_V,y_m, ...) that every command reads; estimates one row per
/// number; alarms one row per message. t_s is tick times sample time in all three. `kind` is
/// "sample", "estimate" or "alarm".
void export_csv(const std::string& input, const std::string& kind, const std::string& output,
                const config::record::ReadOptions& reading = {});

/// JSON, one object a line: what `spoolwatch bridge` sends: a time stamp in seconds and the values
/// by topic.
[[nodiscard]] std::string json_lines(const std::string& input, const Kinds& kinds,
                                     const config::record::ReadOptions& reading = {});

/// One MCAP channel for each topic. Its schema is what its first message has.
[[nodiscard]] std::string mcap_file(const std::string& input, const Kinds& kinds,
                                    const config::record::ReadOptions& reading = {});

}  // namespace workbench::exchange
