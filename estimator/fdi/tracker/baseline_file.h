// Baseline file: healthy values of a rig, written by `spoolwatch isolate --learn`, read by
// [[tracker]]. The file states model with all values, rig, sample time, window, observer and
// tracked parameters; a file that differs in any of these is rejected.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "estimator/greybox/tracking/parameter_tracker.h"

namespace estimator::fdi::tracker {

struct BaselineFile {
  static constexpr std::int64_t kVersion = 2;

  std::int64_t version = kVersion;
  std::string rig_id;                   ///< "": of any rig
  std::string model;                    ///< name of the model
  std::string model_values;             ///< values_line() of the model
  std::string source;                   ///< name of the record
  std::vector<std::string> parameters;  ///< tracked parameters
  std::vector<double> values;           ///< SI
  double sample_time_s = 0.0;
  double window_s = 0.0;
  double observer_per_s = 0.0;
  double rms_m = 0.0;
  double noise_floor_m = 0.0;
  greybox::tracking::ChamberErrors chambers;  ///< unknown: chamber pressures are not used
  std::optional<greybox::tracking::ProcessNoise> noise;  ///< present on a disturbed rig

  void visit(config::schema::Visitor& v);
  void visit_disturbance(config::schema::Visitor& v);
};

/// The whole model as one line (estimator/fdi/snapshot.h).
[[nodiscard]] std::string values_line(const plant_sim::ModelFile& model);

[[nodiscard]] BaselineFile baseline_file(const plant_sim::ModelFile& model,
                                         const greybox::tracking::ParameterSet& set,
                                         const greybox::tracking::TrackerSettings& settings,
                                         const greybox::tracking::Baseline& baseline);

/// Throws config::schema::ConfigError for a file of another version, model, window, observer,
/// sample time, rig (where both are known) or set of tracked parameters in any order: the estimate
/// of one parameter depends on which others were free.
[[nodiscard]] BaselineFile read_baseline(const std::filesystem::path& file,
                                         const plant_sim::ModelFile& model,
                                         const greybox::tracking::TrackerSettings& settings,
                                         const greybox::tracking::ParameterSet& set,
                                         double sample_time_s, const std::string& rig_id);

/// theta of every parameter of the set.
[[nodiscard]] greybox::tracking::Baseline baseline_of(const BaselineFile& file,
                                                      const greybox::tracking::ParameterSet& set);

}  // namespace estimator::fdi::tracker
