// How long a case I fault goes unseen, with a 5 um encoder, a 12-bit D/A converter and 2 um noise:
// whole periods buffered, as in the source, against a sliding window. 40 fault times spread over a
// period of the reference, both directions; and one healthy hour.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "workbench/reproduce/alarm_run.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/text.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

constexpr int kTimes = 40;
constexpr double kFirst_s = 15.0;
constexpr double kPeriod_s = 2.0;
constexpr double kHour_s = 3600.0;

struct Delay {
  double median_s;
  double worst_s;
};

Delay delay(const estimator::fdi::EstimatorConfig& estimator, double factor) {
  const auto config = watching_b1(estimator, kCase1Low, kCase1High);
  std::vector<double> delays_s;
  for (int i = 0; i < kTimes; ++i) {
    const double at_s = kFirst_s + kPeriod_s * i / kTimes;
    const auto scenario = with_fault(with_real_instruments(calibrated()), "supply_pressure_Pa",
                                     factor * 1000.0 * kPa_per_psi, at_s);
    const auto found =
        run_with_alarms(scenario, config, at_s + 6.0, static_cast<std::uint64_t>(i + 1));
    const double on_s = found.next(at_s, factor > 1.0 ? +1 : -1);
    delays_s.push_back(std::isnan(on_s) ? std::numeric_limits<double>::infinity() : on_s - at_s);
  }
  std::sort(delays_s.begin(), delays_s.end());
  return {0.5 * (delays_s[kTimes / 2 - 1] + delays_s[kTimes / 2]), delays_s.back()};
}

double false_alarms(const estimator::fdi::EstimatorConfig& estimator) {
  const auto found = run_with_alarms(with_real_instruments(calibrated()),
                                     watching_b1(estimator, kCase1Low, kCase1High), kHour_s, 2002);
  return static_cast<double>(
      std::count_if(found.changes.begin(), found.changes.end(),
                    [](const AlarmChange& change) { return change.active; }));
}

void add(std::vector<Row>& rows, const std::string& name, double factor, bool sliding) {
  const auto estimator = sliding ? sliding_estimator() : period_estimator();
  const Delay found = delay(estimator, factor);
  rows.push_back(judged(name + ", median delay, s", sliding ? Value() : Value(3.0), found.median_s,
                        sliding ? "median 0.3 s" : "about 3 s, any phase",
                        text("%d fault times over a period", kTimes)));
  rows.push_back(judged(name + ", worst delay, s", {}, found.worst_s,
                        sliding ? "worst 0.6 s" : "information"));
}

}  // namespace

std::vector<Row> detection_delay() {
  std::vector<Row> rows;
  add(rows, "whole periods, Ps 1250 psi", 1.25, false);
  add(rows, "whole periods, Ps 750 psi", 0.75, false);
  const auto sliding = sliding_estimator();
  const std::string name = text("window %.3g s every %.3g s", sliding.window_s, sliding.stride_s);
  add(rows, name + ", Ps 1250 psi", 1.25, true);
  add(rows, name + ", Ps 750 psi", 0.75, true);
  rows.push_back(judged("whole periods, false alarms in one hour", {},
                        false_alarms(period_estimator()), "no false alarm"));
  rows.push_back(judged("sliding window, false alarms in one hour", {}, false_alarms(sliding),
                        "no false alarm"));
  return rows;
}

}  // namespace workbench::reproduce
