// The part of the configuration that may change while the daemon runs: estimators, bands and alarm
// rules.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/schema/error.h"
#include "daemon/daemon_config.h"
#include "daemon/io/evidence.h"
#include "estimator/fdi/pipeline.h"

namespace monitor {

/// The configuration of the fault detection with its learned bands, and a pipeline built from it.
struct DetectionConfig {
  estimator::fdi::PipelineConfig effective;
  std::unique_ptr<estimator::fdi::Pipeline> pipeline;
  std::string text;  ///< fdi::whole_text
};

/// Throws config::schema::ConfigError naming the file.
[[nodiscard]] DetectionConfig make_detection_config(const DaemonConfig& config,
                                                    double sample_time_s);

/// The files that make an evidence folder self-contained; `pipeline_text`: DetectionConfig::text.
[[nodiscard]] std::vector<io::EvidenceFile> evidence_files(DaemonConfig& config,
                                                           const std::string& pipeline_text);

/// Keys that differ between two configurations, such as "[[band]] gain: high".
[[nodiscard]] std::vector<std::string> differences(DaemonConfig& before, DaemonConfig& after);

/// True when a key, as differences() names it, is a limit of a guard.
[[nodiscard]] bool is_guard_limit(const std::string& key);
/// True when a key, as differences() names it, may change while the daemon runs.
[[nodiscard]] bool may_change(const std::string& key,
                              const estimator::fdi::PipelineConfig& pipeline);

/// Returns what `make` returns; a ConfigError in it gets `place` put before its text.
template <class Make>
auto with_place(const std::string& place, const Make& make) {
  try {
    return make();
  } catch (const config::schema::ConfigError& error) {
    throw config::schema::ConfigError(place + ": " + error.what());
  }
}

/// Ids of the bands that wait for limits because bands_file does not exist yet, "" for none.
[[nodiscard]] std::string unlearned_bands(const DaemonConfig& config);

}  // namespace monitor
