// Source of an export: the messages of an LCM log or the rows of a record, one after the other.
#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>

#include "config/messages/handler.h"
#include "config/record/record.h"
#include "workbench/exchange/message.h"

namespace workbench::exchange {

/// Names out of all_kinds().
using Kinds = std::set<std::string>;

/// A line on a terminal that says how far the work is, gone at its end; nothing elsewhere.
class ExportProgress {
 public:
  explicit ExportProgress(const std::string& doing);
  ~ExportProgress();
  ExportProgress(const ExportProgress&) = delete;
  ExportProgress& operator=(const ExportProgress&) = delete;
  void at(std::size_t done, std::size_t of);

 private:
  std::string doing_;
  bool terminal_;
  long shown_ = -1;  ///< percent
};

/// True for an LCM event log. Throws config::schema::Error (65) when the file cannot be read.
[[nodiscard]] bool is_log(const std::string& file);

/// The period of a log's first sample; NaN when it has none.
[[nodiscard]] double sample_time_s(const std::string& log);

/// Every message of these kinds, in the order of the log. What is on one of their channels and of
/// another type is an error (65), and so is a log without any message of this project; one that is
/// cut off is said on standard error.
void read_log(const std::string& log, const Kinds& kinds,
              config::messages::MessageHandler& handler);

/// The same as trees, or the rows of a record as samples: the main columns as y_m and
/// u_applied_V, the further ones by their names.
void each_message(const std::string& input, const Kinds& kinds,
                  const std::function<void(const Message&)>& take,
                  const config::record::ReadOptions& reading = {});

}  // namespace workbench::exchange
