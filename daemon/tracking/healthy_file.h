// What a tracking has learnt of a healthy rig, as a file: written by `spoolwatch isolate --learn`,
// read by [[tracker]]. It says of which model, rig, parameters and window it is; others are
// refused.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/schema/visitor.h"
#include "daemon/tracking/tracker.h"

namespace monitor::tracking {

struct HealthyFile {
  std::string rig_id;                   ///< "": of any rig
  std::string model;                    ///< its name
  std::string fingerprint;              ///< of the model's values and the settings of the windows
  std::string source;                   ///< the record
  std::vector<std::string> parameters;  ///< tracked
  std::vector<double> values;           ///< SI
  double sample_time_s = 0.0;
  double rms_m = 0.0;
  double noise_floor_m = 0.0;

  void visit(config::schema::Visitor& v);
};

/// What a healthy error and healthy values hold for: 16 hexadecimal digits.
[[nodiscard]] std::string fingerprint_of(const plant_sim::ModelFile& model,
                                         const Settings& settings);

[[nodiscard]] HealthyFile healthy_file(const plant_sim::ModelFile& model, const Choice& choice,
                                       const Settings& settings, const Healthy& healthy);

/// Throws config::schema::Error: exit 78 for a file of another model, window, sample time,
/// rig (where both are known) or without one of the parameters.
[[nodiscard]] HealthyFile read_healthy(const std::filesystem::path& file,
                                       const plant_sim::ModelFile& model, const Settings& settings,
                                       const Choice& choice, double sample_time_s,
                                       const std::string& rig_id);

/// Search values of every parameter of the choice.
[[nodiscard]] Healthy healthy_of(const HealthyFile& file, const Choice& choice);

}  // namespace monitor::tracking
