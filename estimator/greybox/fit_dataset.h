// Data set of a fit: records as one long series, split into training and validation samples.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "estimator/greybox/dataset.h"

namespace estimator::greybox {

/// Training samples where no record is held out; the others validate.
struct Split {
  // NOLINTNEXTLINE(readability-identifier-naming): named as the split is, Split::blocks
  enum Kind { blocks, first_half, second_half };

  // NOLINTNEXTLINE(google-explicit-constructor): a kind is a split
  Split(Kind of = blocks, double length_s = 0.0) : kind(of), block_s(length_s) {}
  bool operator==(const Split&) const = default;

  Kind kind;
  /// Length of blocks that begin anew, each a record of its own; 0: blocks of kBlock_s of one run.
  double block_s;
};
inline constexpr const char* kSplits =
    "blocks, blocks:SECONDS (2 or more), first-half, second-half";
/// One of kSplits. Throws config::schema::UsageError.
[[nodiscard]] Split parse_split(std::string_view text);

inline constexpr double kBlock_s = 2.0;  ///< longest block: every other one is fitted
/// Length of a record's blocks: at least two of a short record are fitted, and two score.
[[nodiscard]] double block_s(const Dataset& record);

struct FitDataset {
  std::vector<Dataset> records;
  std::vector<std::size_t> starts;  ///< start of each record in the long series
  // Masks with one number per sample of the long series, 1 or 0; settled samples only.
  Eigen::VectorXd training_mask;
  Eigen::VectorXd validation_mask;
  Eigen::VectorXd all_mask;        ///< training or validation
  std::size_t fitted_records = 0;  ///< the first of `records`; the others only validate
  /// Mean over the records with a known noise floor; NaN when there is none (below 20 Hz).
  double noise_floor_m = 0.0;
  /// Bound of the noise floor from below, known at any rate: root of the records' mean square.
  double least_floor_m = 0.0;
  /// Bound of the sensor's noise from above, as a ratio to `noise_floor_m`.
  double most_sensor_ratio = 3.0;
  double sample_time_s = 0.0;  ///< first record

  [[nodiscard]] Eigen::Index size() const { return all_mask.size(); }
  /// True when whole records are held out.
  [[nodiscard]] bool has_holdouts() const { return fitted_records < records.size(); }
  /// Samples for final values: all except held-out records.
  [[nodiscard]] const Eigen::VectorXd& final_weights() const {
    return has_holdouts() ? training_mask : all_mask;
  }
};

/// `holdouts` are records for validation only; with them every sample of `records` is fitted.
/// Halves of records and blocks of a stated length become records of their own, each with its own
/// start; the first, third, ... block is fitted. Requires at least one record. Throws
/// config::schema::DataError for a record without two blocks.
[[nodiscard]] FitDataset fit_dataset(std::vector<Dataset> records, std::vector<Dataset> holdouts,
                                     Split split = Split::blocks);

/// Where the noise floor is not known, takes its bound from below in its place and lets the noise
/// exceed it freely.
void assume_noise_floor(FitDataset& data);

/// sqrt(sum w r^2 / sum w).
[[nodiscard]] double rms(const Eigen::Ref<const Eigen::VectorXd>& residual_m,
                         const Eigen::VectorXd& weights);

}  // namespace estimator::greybox
