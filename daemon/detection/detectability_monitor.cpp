#include "daemon/detection/detectability_monitor.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace monitor::detection {
namespace {

constexpr std::string_view kSmallest = "smallest_";
constexpr std::string_view kDisturbance = "disturbance_";

}  // namespace

void DetectabilityMonitor::update(const estimator::fdi::EstimateEvent& event) {
  const auto tells = [](const estimator::fdi::EstimatedValue& value) {
    return std::string_view(value.name).starts_with(kSmallest);
  };
  if (std::none_of(event.begin(), event.end(), tells)) return;
  io::Detectable now{std::string(event.source), event.tick, std::string(event.reason), {}, {}};
  for (const estimator::fdi::EstimatedValue& value : event) {
    const std::string_view name = value.name;
    if (name.starts_with(kDisturbance) && std::isfinite(value.value)) {
      now.disturbance.emplace_back(name.substr(kDisturbance.size()), value.value);
    }
    if (!tells(value)) continue;
    now.changes.push_back({std::string(name.substr(kSmallest.size())), value.value});
  }
  const std::lock_guard lock(mutex_);
  const auto at = std::find_if(sources_.begin(), sources_.end(),
                               [&](const io::Detectable& one) { return one.source == now.source; });
  if (at == sources_.end()) {
    sources_.push_back(std::move(now));
  } else {
    *at = std::move(now);
  }
}

void DetectabilityMonitor::clear() {
  const std::lock_guard lock(mutex_);
  sources_.clear();
}

std::vector<io::Detectable> DetectabilityMonitor::read() const {
  const std::lock_guard lock(mutex_);
  return sources_;
}

}  // namespace monitor::detection
