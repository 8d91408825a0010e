#include "estimator/greybox/representative_segments.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace estimator::greybox {
namespace {

struct Stretch {
  std::size_t begin;
  std::size_t end;
};

/// Of [begin, end) the `length` samples with the longest way of the rod, of those that begin
/// every quarter of it.
Stretch liveliest(const Measured& record, std::size_t begin, std::size_t end, std::size_t length) {
  std::vector<double> way_m(end - begin, 0.0);
  for (std::size_t i = begin + 1; i < end; ++i) {
    way_m[i - begin] = way_m[i - begin - 1] + std::abs(record.y_m[i] - record.y_m[i - 1]);
  }
  std::size_t from = 0;
  double longest_m = -1.0;
  for (std::size_t i = 0; i + length <= way_m.size(); i += std::max<std::size_t>(1, length / 4)) {
    const double stretch_m = way_m[i + length - 1] - way_m[i];
    if (stretch_m > longest_m) {
      longest_m = stretch_m;
      from = i;
    }
  }
  return {begin + from, begin + std::min(from + length, way_m.size())};
}

std::vector<Stretch> stretches(const Measured& record, double share) {
  const auto length = static_cast<std::size_t>(std::lround(kStretch_s / record.sample_time_s));
  if (record.size() < 2 * length) return {{0, record.size()}};
  const double wanted = share * static_cast<double>(record.size()) / static_cast<double>(length);
  const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(wanted)));
  std::vector<Stretch> found;
  for (std::size_t i = 0; i < count; ++i) {
    found.push_back(
        liveliest(record, i * record.size() / count, (i + 1) * record.size() / count, length));
  }
  return found;
}

void add(Measured& to, const Measured& from) {
  for (const std::size_t start : from.starts) to.starts.push_back(to.size() + start);
  const auto join = [](auto& values, const auto& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  join(to.t_s, from.t_s);
  join(to.u_V, from.u_V);
  join(to.y_m, from.y_m);
  join(to.settled, from.settled);
  to.led.resize(to.size() - from.size());
  join(to.led, from.led);
  to.led.resize(to.size());
}

}  // namespace

double length_s(const Evidence& evidence) {
  double total_s = 0.0;
  for (const Measured& record : evidence.records) {
    total_s += static_cast<double>(record.size()) * record.sample_time_s;
  }
  return total_s;
}

Evidence stretches_of(const Evidence& whole) {
  const double share = std::min(1.0, kSearched_s / length_s(whole));
  Evidence result;
  result.fitted_records = whole.fitted_records;
  result.noise_floor_m = whole.noise_floor_m;
  result.sample_time_s = whole.sample_time_s;
  std::vector<double> fits;
  std::vector<double> scores;
  for (std::size_t r = 0; r < whole.records.size(); ++r) {
    const Measured& record = whole.records[r];
    Measured kept;
    kept.name = record.name;
    kept.sample_time_s = record.sample_time_s;
    result.starts.push_back(fits.size());
    for (const Stretch& stretch : stretches(record, share)) {
      Measured piece = part(record, stretch.begin, stretch.end);
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(whole.starts[r] + stretch.begin + i);
        fits.push_back(piece.settled[i] != 0 ? whole.fits[at] : 0.0);
        scores.push_back(piece.settled[i] != 0 ? whole.scores[at] : 0.0);
      }
      add(kept, piece);
    }
    result.records.push_back(std::move(kept));
  }
  const auto size = static_cast<Eigen::Index>(fits.size());
  result.fits = Eigen::Map<Eigen::VectorXd>(fits.data(), size);
  result.scores = Eigen::Map<Eigen::VectorXd>(scores.data(), size);
  result.counts = result.fits + result.scores;
  return result;
}

}  // namespace estimator::greybox
