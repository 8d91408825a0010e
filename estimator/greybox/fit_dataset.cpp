#include "estimator/greybox/fit_dataset.h"

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"
#include "estimator/greybox/dataset.h"
#include "estimator/residual/noise_floor.h"

namespace estimator::greybox {
namespace {

constexpr double kFewestBlocks = 4.0;

bool in_fitted_block(const Dataset& record, std::size_t i) {
  const double since_s = record.t_s[i] - record.t_s.front();
  return static_cast<long>(since_s / block_s(record)) % 2 == 0;
}

}  // namespace

double block_s(const Dataset& record) {
  const double length_s = record.t_s.back() - record.t_s.front() + record.sample_time_s;
  return std::min(kBlock_s, length_s / kFewestBlocks);
}

Split parse_split(std::string_view text) {
  if (text == "blocks") return Split::blocks;
  if (text == "first-half") return Split::first_half;
  if (text == "second-half") return Split::second_half;
  throw config::schema::UsageError("--fit: is " + std::string(text) +
                                   "; allowed: blocks, first-half, second-half");
}

FitDataset fit_dataset(std::vector<Dataset> records, std::vector<Dataset> holdouts, Split split) {
  if (holdouts.empty() && split != Split::blocks) {
    std::vector<Dataset> first;
    std::vector<Dataset> second;
    for (const Dataset& record : records) {
      first.push_back(part(record, 0, record.size() / 2));
      second.push_back(part(record, record.size() / 2, record.size()));
    }
    if (split == Split::second_half) first.swap(second);
    return fit_dataset(std::move(first), std::move(second));
  }
  FitDataset result;
  const std::size_t fitted_records = records.size();
  const bool apart = !holdouts.empty();
  result.fitted_records = fitted_records;
  result.sample_time_s = records.front().sample_time_s;
  result.records = std::move(records);
  for (Dataset& record : holdouts) result.records.push_back(std::move(record));
  std::size_t total = 0;
  for (const Dataset& record : result.records) total += record.size();
  result.training_mask.setZero(static_cast<Eigen::Index>(total));
  result.validation_mask = result.training_mask;
  Eigen::Index at = 0;
  double square_m2 = 0.0;
  double least_m2 = 0.0;
  std::size_t told = 0;
  for (std::size_t r = 0; r < result.records.size(); ++r) {
    const Dataset& record = result.records[r];
    result.starts.push_back(static_cast<std::size_t>(at));
    const auto samples = static_cast<double>(record.size());
    const estimator::residual::NoiseFloor floor =
        estimator::residual::noise_floor(record.y_m, record.sample_time_s);
    least_m2 += std::pow(std::max(floor.least_m, kLeastFloor_m), 2) * samples;
    if (std::isfinite(floor.sd_m)) {
      square_m2 += std::pow(std::max(floor.sd_m, kLeastFloor_m), 2) * samples;
      told += record.size();
    }
    for (std::size_t i = 0; i < record.size(); ++i, ++at) {
      if (record.valid[i] == 0) continue;
      const bool fitted = apart ? r < fitted_records : in_fitted_block(record, i);
      (fitted ? result.training_mask : result.validation_mask)[at] = 1.0;
    }
  }
  result.all_mask = result.training_mask + result.validation_mask;
  result.noise_floor_m = std::sqrt(square_m2 / static_cast<double>(told));
  result.least_floor_m = std::sqrt(least_m2 / static_cast<double>(total));
  return result;
}

void assume_noise_floor(FitDataset& data) {
  constexpr double kMostRatio = 300.0;
  if (std::isfinite(data.noise_floor_m)) return;
  data.noise_floor_m = data.least_floor_m;
  data.most_sensor_ratio = kMostRatio;
}

double rms(const Eigen::Ref<const Eigen::VectorXd>& residual_m, const Eigen::VectorXd& weights) {
  const double samples = std::max(weights.sum(), 1.0);
  return std::sqrt((residual_m.array().square() * weights.array()).sum() / samples);
}

}  // namespace estimator::greybox
