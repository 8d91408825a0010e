#include "estimator/greybox/tracking/sample_buffer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace estimator::greybox::tracking {
namespace {

constexpr double kNotRead = std::numeric_limits<double>::quiet_NaN();

}  // namespace

SampleBuffer::SampleBuffer(std::size_t lead, std::size_t window)
    : lead_(lead),
      needed_(lead + window),
      u_V_(2 * needed_),
      y_m_(u_V_.size()),
      supply_Pa_(u_V_.size(), kNotRead),
      in_Pa_(u_V_.size(), kNotRead),
      out_Pa_(u_V_.size(), kNotRead) {}

void SampleBuffer::push(double u_V, double y_m, const config::signals::Pressures& pressures) {
  if (kept_ == u_V_.size()) {
    for (std::vector<double>* column : {&u_V_, &y_m_, &supply_Pa_, &in_Pa_, &out_Pa_}) {
      std::copy(column->end() - static_cast<std::ptrdiff_t>(needed_), column->end(),
                column->begin());
    }
    kept_ = needed_;
  }
  u_V_[kept_] = u_V;
  y_m_[kept_] = y_m;
  supply_Pa_[kept_] = pressures.supply_Pa;
  in_Pa_[kept_] = pressures.in_Pa;
  out_Pa_[kept_] = pressures.out_Pa;
  ++kept_;
}

WindowData SampleBuffer::latest(std::size_t samples) const noexcept {
  const std::size_t from = kept_ - samples - lead_;
  WindowData data{u_V_.data() + from, y_m_.data() + from, lead_, samples};
  const auto read = [&](const std::vector<double>& column) {
    return std::all_of(column.data() + from, column.data() + kept_,
                       [](double value) { return std::isfinite(value); });
  };
  if (!read(in_Pa_) || !read(out_Pa_)) return data;
  data.in_Pa = in_Pa_.data() + from;
  data.out_Pa = out_Pa_.data() + from;
  return data;
}

const double* SampleBuffer::supply_Pa(std::size_t samples) const noexcept {
  const double* const last = supply_Pa_.data() + kept_;
  const bool read = std::all_of(last - samples, last, [](double value) { return value > 0.0; });
  return read ? last - samples : nullptr;
}

void SampleBuffer::serialize(estimator::StateArchive& archive) {
  for (std::vector<double>* column : {&u_V_, &y_m_, &supply_Pa_, &in_Pa_, &out_Pa_}) {
    archive.fixed(*column);
  }
  archive.value(kept_);
  if (archive.restores() && kept_ > u_V_.size()) archive.fail();
}

}  // namespace estimator::greybox::tracking
