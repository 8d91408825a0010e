// The times at which alarms stood, and how two lists of them compare.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace workbench::replay {

/// An alarm from its coming to its going.
struct Occurrence {
  std::string alarm;  ///< SOURCE.NAME
  double from_s = 0.0;
  double to_s = std::numeric_limits<double>::quiet_NaN();  ///< NaN: it stood at the log's end
  int severity = 0;                                        ///< when it came, as in alarm_t
  int direction = 0;
  /// When a limit was passed; NaN: the estimate was INVALID all the time.
  double limit_s = std::numeric_limits<double>::quiet_NaN();
};

/// Alarms that come and go, as occurrences in the order of their coming.
class OccurrenceList {
 public:
  /// State of an alarm at a time, changed or not.
  void tell(const std::string& alarm, double t_s, bool active, int severity, int direction);
  [[nodiscard]] const std::vector<Occurrence>& all() const noexcept { return all_; }

 private:
  std::vector<Occurrence> all_;
};

/// The occurrences in which a limit was passed, each from then on.
[[nodiscard]] std::vector<Occurrence> passed_limits(const std::vector<Occurrence>& all);

struct Shift {
  Occurrence before, after;
};

struct OccurrenceDifference {
  std::vector<Occurrence> appears, disappears;
  std::vector<Shift> shifts;  ///< comes or goes at another time, or in another direction
  std::int64_t same = 0;
};

/// Two of one alarm are the same one when they overlap, or come within `tolerance_s`; each is
/// matched once, in the order of time. Times that differ by less than `sample_s` are equal.
[[nodiscard]] OccurrenceDifference compare(const std::vector<Occurrence>& before,
                                           const std::vector<Occurrence>& after, double tolerance_s,
                                           double sample_s);

}  // namespace workbench::replay
