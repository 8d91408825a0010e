#include "estimator/greybox/representative_segments.h"

#include <algorithm>
#include <cmath>

#include "estimator/greybox/kinematics.h"

namespace estimator::greybox {
namespace {

/// The `length` samples of [begin, end) with the longest travel, starts a quarter length apart.
SampleRange longest_travel(const Dataset& record, std::size_t begin, std::size_t end,
                           std::size_t length) {
  std::vector<double> travel_m(end - begin, 0.0);
  for (std::size_t i = begin + 1; i < end; ++i) {
    travel_m[i - begin] = travel_m[i - begin - 1] + std::abs(record.y_m[i] - record.y_m[i - 1]);
  }
  std::size_t from = 0;
  double longest_travel_m = -1.0;
  for (std::size_t i = 0; i + length <= travel_m.size();
       i += std::max<std::size_t>(1, length / 4)) {
    const double travelled_m = travel_m[i + length - 1] - travel_m[i];
    if (travelled_m > longest_travel_m) {
      longest_travel_m = travelled_m;
      from = i;
    }
  }
  return {begin + from, begin + std::min(from + length, travel_m.size())};
}

std::vector<SampleRange> segments_of(const Dataset& record, double share) {
  const auto length = static_cast<std::size_t>(std::lround(kSegment_s / record.sample_time_s));
  if (record.size() < 2 * length) return {{0, record.size()}};
  const double wanted = share * static_cast<double>(record.size()) / static_cast<double>(length);
  const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(wanted)));
  std::vector<SampleRange> found;
  for (std::size_t i = 0; i < count; ++i) {
    found.push_back(
        longest_travel(record, i * record.size() / count, (i + 1) * record.size() / count, length));
  }
  return found;
}

void add(Dataset& to, const Dataset& from) {
  for (const std::size_t start : from.starts) to.starts.push_back(to.size() + start);
  const auto join = [](auto& values, const auto& more) {
    values.insert(values.end(), more.begin(), more.end());
  };
  join(to.t_s, from.t_s);
  join(to.u_V, from.u_V);
  join(to.y_m, from.y_m);
  join(to.valid, from.valid);
  to.initialising.resize(to.size() - from.size());
  join(to.initialising, from.initialising);
  to.initialising.resize(to.size());
}

}  // namespace

double length_s(const FitDataset& data) {
  double total_s = 0.0;
  for (const Dataset& record : data.records) {
    total_s += static_cast<double>(record.size()) * record.sample_time_s;
  }
  return total_s;
}

FitDataset representative_segments(const FitDataset& whole) {
  const double often = std::clamp(kUsualRate_Hz * whole.sample_time_s, 1.0, kMostOften);
  const double share = std::min(1.0, often * kSearched_s / length_s(whole));
  FitDataset result;
  result.fitted_records = whole.fitted_records;
  result.noise_floor_m = whole.noise_floor_m;
  result.least_floor_m = whole.least_floor_m;
  result.most_sensor_ratio = whole.most_sensor_ratio;
  result.sample_time_s = whole.sample_time_s;
  std::vector<double> training;
  std::vector<double> validation;
  for (std::size_t r = 0; r < whole.records.size(); ++r) {
    const Dataset& record = whole.records[r];
    Dataset kept;
    kept.name = record.name;
    kept.sample_time_s = record.sample_time_s;
    kept.command_is_interpolated = record.command_is_interpolated;
    result.starts.push_back(training.size());
    for (const SampleRange& range : segments_of(record, share)) {
      Dataset piece = part(record, range.begin, range.end);
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(whole.starts[r] + range.begin + i);
        training.push_back(piece.valid[i] != 0 ? whole.training_mask[at] : 0.0);
        validation.push_back(piece.valid[i] != 0 ? whole.validation_mask[at] : 0.0);
      }
      add(kept, piece);
    }
    result.records.push_back(std::move(kept));
  }
  const auto size = static_cast<Eigen::Index>(training.size());
  result.training_mask = Eigen::Map<Eigen::VectorXd>(training.data(), size);
  result.validation_mask = Eigen::Map<Eigen::VectorXd>(validation.data(), size);
  result.all_mask = result.training_mask + result.validation_mask;
  return result;
}

}  // namespace estimator::greybox
