#include "workbench/scorecard/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/joined.h"
#include "workbench/scorecard/statistics.h"

namespace workbench::scorecard {

namespace {

std::string share_of_time(double share) {
  const double percent = 100.0 * share;
  return (percent < 1.0 ? fmt::format("{:.2g}", percent) : fmt::format("{:.0f}", percent)) +
         " % of time";
}

}  // namespace

std::string alarms_words(const QuietFigures& q) {
  if (!(q.hours > 0.0)) return "–";
  return std::to_string(q.counted.alarms) + fmt::format(" in {:.3g} h", q.hours);
}

std::string unusable_words(const std::string& motion, const std::string& why) {
  return "cannot be used on " + motion + ": " + why;
}

std::string rate_words(const QuietFigures& q) {
  if (!(q.hours > 0.0)) return "–";
  return fmt::format("{:.2g} (< ", q.per_hour()) + fmt::format("{:.2g})", q.per_hour_upper());
}

std::string benign_words(const QuietFigures& q) {
  if (!(q.hours > 0.0)) return "–";
  const double share = q.counted.alarm_s / (3600.0 * q.hours);
  std::string out = fmt::format("{:.2g} /h", q.per_hour());
  if (q.counted.alarms > 0) out += ", " + share_of_time(share);
  return out;
}

std::string share_words(int count, int of) {
  if (of == 0) return "–";
  const double percent = 100.0 * count / of;
  // Never rounded to all or none.
  if (count > 0 && percent < 0.5) return "< 1 %";
  if (count < of && percent > 99.5) return "> 99 %";
  return fmt::format("{:.0f} %", percent);
}

std::string fault_words(const Fault& fault) {
  std::string out = fault.id;
  std::replace(out.begin(), out.end(), '_', ' ');
  return out;
}

std::string sized_words(const Fault& fault) {
  return fault_words(fault) + (fault.stated > 0.0 ? ", " + stated_words(fault) : "");
}

std::string stated_words(const Fault& fault) {
  if (fault.stated == 0.0) return "";
  const bool both = fault.directions().size() > 1;
  const std::string sign = both ? "±" : (fault.directions().front() > 0 ? "+" : "−");
  return sign + fmt::format("{:.3g} ", fault.stated) + fault.unit;
}

std::string size_words(const FaultFigures::Smallest& smallest) {
  return (smallest.beyond ? "> " : "") + fmt::format("{:.3g}", smallest.size);
}

std::string smallest_words(const Card& card, const MethodFigures& method, const Fault& fault) {
  const FaultFigures* const of = figures_of(method, fault);
  if (of == nullptr || !(fault.least > 0.0)) return "–";
  std::vector<std::string> sizes;
  for (const std::string& motion : card.motions) {
    const auto smallest = of->smallest(motion);
    sizes.push_back(smallest ? size_words(*smallest) : "–");
  }
  const bool same =
      std::adjacent_find(sizes.begin(), sizes.end(), std::not_equal_to<>()) == sizes.end();
  std::string out = sizes.front();
  for (std::size_t i = 1; i < sizes.size() && !same; ++i) out += " / " + sizes[i];
  return out + (out == "–" ? "" : " " + fault.unit);
}

std::string delay_words(const MethodFigures& method, const Fault& fault) {
  const FaultFigures* const of = figures_of(method, fault);
  if (of == nullptr || of->trials() == 0) return "–";
  const auto words = [](double delay_s) {
    return std::isfinite(delay_s) ? fmt::format("{:.2g}", delay_s) : std::string("–");
  };
  const double median_s = quantile(of->delays_s(), 0.5);
  const double late_s = quantile(of->delays_s(), kDetected);
  if (!std::isfinite(median_s)) return "–";
  return words(median_s) + " (" + words(late_s) + ") s";
}

std::string first_words(const FaultFigures& of) {
  std::vector<std::pair<std::string, int>> names(of.first.begin(), of.first.end());
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  const auto text = [](const auto& one) {
    return names_words(one.first) + " " + std::to_string(one.second);
  };
  return config::schema::joined_by(names, text, "; ");
}

std::string detected_words(const Card& card) {
  const auto n = card.seeds;
  auto k = n;
  while (k > 0 && enough(k - 1, n, kDetected)) --k;
  return fmt::format("Detected: an alarm within {:.3g} s in ", card.watch_s) + std::to_string(k) +
         " of " + std::to_string(n) +
         fmt::format(
             " trials at least, none standing before (Clopper-Pearson: a share of {:.2f} or more "
             "with 95 %); the worse direction.",
             clopper_pearson_lower(k, n));
}

std::vector<const Fault*> faults_of(const Card& card) {
  std::vector<const Fault*> faults;
  for (const MethodFigures& method : card.methods) {
    for (const FaultFigures& of : method.faults) {
      if (std::find(faults.begin(), faults.end(), of.fault) == faults.end()) {
        faults.push_back(of.fault);
      }
    }
  }
  std::sort(faults.begin(), faults.end());  // they lie in the plan's list
  return faults;
}

const FaultFigures* figures_of(const MethodFigures& method, const Fault& fault) {
  for (const FaultFigures& of : method.faults) {
    if (of.fault == &fault) return &of;
  }
  return nullptr;
}

}  // namespace workbench::scorecard
