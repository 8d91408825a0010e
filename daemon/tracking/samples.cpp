#include "daemon/tracking/samples.h"

#include <algorithm>
#include <limits>

namespace monitor::tracking {

Samples::Samples(std::size_t lead, std::size_t window)
    : lead_(lead),
      needed_(lead + window),
      u_V_(2 * needed_),
      y_m_(u_V_.size()),
      supply_Pa_(u_V_.size(), std::numeric_limits<double>::quiet_NaN()) {}

void Samples::push(double u_V, double y_m, double supply_Pa) {
  if (kept_ == u_V_.size()) {
    const auto half = static_cast<std::ptrdiff_t>(needed_);
    std::copy(u_V_.end() - half, u_V_.end(), u_V_.begin());
    std::copy(y_m_.end() - half, y_m_.end(), y_m_.begin());
    std::copy(supply_Pa_.end() - half, supply_Pa_.end(), supply_Pa_.begin());
    kept_ = needed_;
  }
  u_V_[kept_] = u_V;
  y_m_[kept_] = y_m;
  supply_Pa_[kept_] = supply_Pa;
  ++kept_;
}

Cut Samples::latest(std::size_t samples) const noexcept {
  const std::size_t from = kept_ - samples - lead_;
  return {u_V_.data() + from, y_m_.data() + from, lead_, samples};
}

const double* Samples::supply_Pa(std::size_t samples) const noexcept {
  const double* const last = supply_Pa_.data() + kept_;
  const bool read = std::all_of(last - samples, last, [](double value) { return value > 0.0; });
  return read ? last - samples : nullptr;
}

void Samples::carry(estimator::Carrier& carrier) {
  carrier.fixed(u_V_);
  carrier.fixed(y_m_);
  carrier.fixed(supply_Pa_);
  carrier.value(kept_);
  if (carrier.restores() && kept_ > u_V_.size()) carrier.fail();
}

}  // namespace monitor::tracking
