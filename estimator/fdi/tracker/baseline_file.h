// What a tracking has learnt of a healthy rig, as a file: written by `spoolwatch isolate --learn`,
// read by [[tracker]]. It says of which model with all its values, rig, sample time, window,
// observer and tracked parameters it is; others are refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "estimator/greybox/tracking/parameter_tracker.h"

namespace estimator::fdi::tracker {

struct BaselineFile {
  static constexpr std::int64_t kVersion = 2;

  std::int64_t version = kVersion;
  std::string rig_id;                   ///< "": of any rig
  std::string model;                    ///< its name
  std::string model_values;             ///< values_line() of it
  std::string source;                   ///< the record
  std::vector<std::string> parameters;  ///< tracked
  std::vector<double> values;           ///< SI
  double sample_time_s = 0.0;
  double window_s = 0.0;
  double observer_per_s = 0.0;
  double rms_m = 0.0;
  double noise_floor_m = 0.0;
  greybox::tracking::ChamberErrors chambers;  ///< not known: chamber pressures are not used

  void visit(config::schema::Visitor& v);
};

/// All that the model is, as one line (estimator/fdi/snapshot.h).
[[nodiscard]] std::string values_line(const plant_sim::ModelFile& model);

[[nodiscard]] BaselineFile baseline_file(const plant_sim::ModelFile& model,
                                         const greybox::tracking::ParameterSet& set,
                                         const greybox::tracking::TrackerSettings& settings,
                                         const greybox::tracking::Baseline& baseline);

/// Throws config::schema::ConfigError for a file of another version, model, window, observer,
/// sample time, rig (where both are known) or list of tracked parameters, whatever its order: what
/// one of them was found to be depends on which others were free.
[[nodiscard]] BaselineFile read_baseline(const std::filesystem::path& file,
                                         const plant_sim::ModelFile& model,
                                         const greybox::tracking::TrackerSettings& settings,
                                         const greybox::tracking::ParameterSet& set,
                                         double sample_time_s, const std::string& rig_id);

/// Search values of every parameter of the choice.
[[nodiscard]] greybox::tracking::Baseline baseline_of(const BaselineFile& file,
                                                      const greybox::tracking::ParameterSet& set);

}  // namespace estimator::fdi::tracker
