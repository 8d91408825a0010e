// Reads what the daemon sends, message by message, and says what is wrong with it: numbers without
// gaps, time on the grid, every alarm within its time, estimates at the end as at the beginning.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "spoolwatch/alarm_t.hpp"
#include "spoolwatch/estimate_t.hpp"
#include "spoolwatch/health_t.hpp"
#include "spoolwatch/sample_t.hpp"
#include "tests/soak/alarm_watch.h"

namespace soak {

/// Values of one coefficient in healthy stretches.
struct Spread {
  std::int64_t count = 0;
  double mean = 0.0;
  double squares = 0.0;  ///< sum of the squared distances from the mean
  double low = 0.0;
  double high = 0.0;
  void add(double value) noexcept;
  [[nodiscard]] double deviation() const noexcept;
};

struct Coefficient {
  std::string source, name;
  Spread first, last;  ///< in the first and the last hour
};

class StreamCheck {
 public:
  /// Checks a run with the bands and estimators of config/demo.toml; `period_ns`: the loop's.
  StreamCheck(const std::vector<Fault>& faults, double duration_s, std::int64_t period_ns);

  /// One event of a log.
  void take(std::string_view channel, const void* data, int size);
  /// Nothing more comes.
  void finish();

  [[nodiscard]] std::int64_t samples() const noexcept { return samples_; }
  [[nodiscard]] double time_s() const noexcept { return t_s_; }
  [[nodiscard]] const std::vector<std::string>& problems() const noexcept { return problems_; }
  [[nodiscard]] std::int64_t problem_count() const noexcept { return problem_count_; }
  [[nodiscard]] const std::vector<AlarmWatch>& alarms() const noexcept { return alarms_; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const noexcept {
    return coefficients_;
  }

 private:
  void sample(const spoolwatch::sample_t& s);
  void estimate(const spoolwatch::estimate_t& e);
  void alarm(const spoolwatch::alarm_t& a);
  void health(const spoolwatch::health_t& h);
  void problem(const std::string& what);
  void collect();
  bool in_turn(std::size_t channel, std::int64_t seq);

  /// Within no fault, and long enough after the one before for every window to be free of it.
  bool healthy();

  std::vector<Fault> faults_;
  std::size_t next_fault_ = 0;  ///< the first that is not over
  double duration_s_;
  std::int64_t period_ns_;
  std::vector<AlarmWatch> alarms_;
  std::vector<std::size_t> told_;  ///< problems of each alarm that are in problems_
  std::vector<Coefficient> coefficients_;
  std::array<std::int64_t, 4> seq_{};
  std::int64_t samples_ = 0;
  std::int64_t repeats_ = 0;  ///< since the last health message
  double t_s_ = 0.0;
  std::int64_t problem_count_ = 0;
  std::vector<std::string> problems_;
  spoolwatch::sample_t sample_{};
  spoolwatch::estimate_t estimate_{};
  spoolwatch::alarm_t alarm_{};
  spoolwatch::health_t health_{};
};

}  // namespace soak
