#include "estimator/greybox/fit_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "config/schema/error.h"
#include "estimator/greybox/dataset.h"
#include "estimator/residual/noise_floor.h"

namespace estimator::greybox {
namespace {

constexpr double kFewestBlocks = 4.0;
/// A block that begins anew and is shorter hardly outlives its settling.
constexpr double kShortestBlock_s = 2.0;

bool in_fitted_block(const Dataset& record, std::size_t i) {
  const double since_s = record.t_s[i] - record.t_s.front();
  return static_cast<long>(since_s / block_s(record)) % 2 == 0;
}

/// First sample of each block of the stated length; a last one below kShortestBlock_s belongs to
/// the one before.
std::vector<std::size_t> block_starts(const Dataset& record, double length_s) {
  std::vector<std::size_t> starts{0};
  // a time that is rounded below a block's start belongs to that block
  const double early_s = 0.5 * record.sample_time_s;
  double next = 1.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double blocks = (record.t_s[i] - record.t_s.front() + early_s) / length_s;
    if (blocks < next) continue;
    if (record.t_s.back() - record.t_s[i] + record.sample_time_s < kShortestBlock_s) break;
    starts.push_back(i);
    next = std::floor(blocks) + 1.0;
  }
  if (starts.size() > 1) return starts;
  throw config::schema::bad_data(record.name, fmt::format("has one block of {:g} s", length_s),
                                 "--fit blocks:SECONDS of half its length or less");
}

FitDataset fit_stated_blocks(const std::vector<Dataset>& records, double length_s) {
  std::vector<Dataset> fitted;
  std::vector<Dataset> scored;
  for (const Dataset& record : records) {
    std::vector<std::size_t> bounds = block_starts(record, length_s);
    bounds.push_back(record.size());
    for (std::size_t b = 0; b + 1 < bounds.size(); ++b) {
      (b % 2 == 0 ? fitted : scored).push_back(part(record, bounds[b], bounds[b + 1]));
    }
  }
  return fit_dataset(std::move(fitted), std::move(scored));
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
  constexpr std::string_view kStated = "blocks:";
  if (text.starts_with(kStated)) {
    const char* const end = text.data() + text.size();
    double length_s = 0.0;
    const auto [rest, error] = std::from_chars(text.data() + kStated.size(), end, length_s);
    if (error == std::errc() && rest == end && length_s >= kShortestBlock_s &&
        std::isfinite(length_s)) {
      return {Split::blocks, length_s};
    }
  }
  throw config::schema::UsageError("--fit: is " + std::string(text) + "; allowed: " + kSplits);
}

FitDataset fit_dataset(std::vector<Dataset> records, std::vector<Dataset> holdouts, Split split) {
  if (holdouts.empty() && split.block_s > 0.0) return fit_stated_blocks(records, split.block_s);
  if (holdouts.empty() && split.kind != Split::blocks) {
    std::vector<Dataset> first;
    std::vector<Dataset> second;
    for (const Dataset& record : records) {
      first.push_back(part(record, 0, record.size() / 2));
      second.push_back(part(record, record.size() / 2, record.size()));
    }
    if (split.kind == Split::second_half) first.swap(second);
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
