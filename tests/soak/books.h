// Adds up what a run left behind: what the daemon counted against what its log holds.
//
//   ticks + skipped periods                  = periods of the grid up to the last tick
//   samples sent + dropped to the detector   = ticks
//   messages missing by sequence number      = dropped + lost records
//   periods missing between samples          = skipped + dropped + samples not in the log
//   breaks in tick numbers                   = overruns, where nothing else is missing
//
// Each of what was counted must be in the last health message, and have raised its alarm.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"

namespace soak {

struct Row {
  std::string what;
  std::int64_t counted;  ///< by the daemon
  std::int64_t found;    ///< in the log
  bool holds;
};

/// The line that the daemon ends with.
struct ClosingReport {
  std::int64_t ticks, overruns, skipped_periods, dropped_samples;
};
/// Nothing when there is no such line in the text.
std::optional<ClosingReport> closing_report(const std::string& text);

class Books {
 public:
  /// Messages in the order of the log.
  void take(std::string_view channel, const void* data, int size);
  void sample(const spoolwatch::sample_t& s);
  void alarm(const spoolwatch::alarm_t& a);
  void health(const spoolwatch::health_t& h);
  void estimate(std::int64_t seq) { missing(1, seq); }

  /// `complete`: nothing may be missing in the log, counted or not.
  [[nodiscard]] std::vector<Row> balance(const ClosingReport& closing, bool complete) const;

 private:
  /// How many messages are missing just before this one.
  std::int64_t missing(std::size_t channel, std::int64_t seq);
  [[nodiscard]] bool told(const char* source, const char* name) const;

  std::array<std::int64_t, 4> next_seq_{};
  std::array<std::int64_t, 4> missing_{};
  std::int64_t samples_ = 0;
  std::int64_t last_tick_ = -1;
  std::int64_t missing_periods_ = 0;
  std::int64_t breaks_ = 0;
  std::int64_t wrong_gaps_ = 0;  ///< samples that state another gap than their tick
  std::int64_t backwards_ = 0;   ///< counters of health that fell, ticks that did not rise
  std::int64_t damaged_ = 0;
  spoolwatch::health_t last_{};
  std::set<std::string> alarms_;  ///< SOURCE.NAME of each that came
};

/// Prints the table; true when every row holds.
bool print(const std::vector<Row>& rows, std::ostream& out);

}  // namespace soak
