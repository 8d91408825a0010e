// The part of the configuration that may change while the daemon runs: what is estimated, and when
// an alarm comes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "config/schema/error.h"
#include "daemon/daemon_config.h"
#include "daemon/io/evidence.h"
#include "estimator/fdi/pipeline.h"

namespace monitor {

/// The rules with the learned bands in them, and a pipeline by them.
struct DetectionConfig {
  estimator::fdi::PipelineConfig effective;
  std::unique_ptr<estimator::fdi::Pipeline> pipeline;
  std::string text;  ///< fdi::whole_text
};

/// Throws config::schema::ConfigError that names the file.
[[nodiscard]] DetectionConfig make_detection_config(const DaemonConfig& config, double sample_time_s);

/// The files that evidence needs to be read by itself; `pipeline_text`: DetectionConfig::text.
[[nodiscard]] std::vector<io::EvidenceFile> evidence_files(DaemonConfig& config,
                                                           const std::string& pipeline_text);

/// "[[band]] gain: high", ... of what differs between two configurations.
[[nodiscard]] std::vector<std::string> differences(DaemonConfig& before, DaemonConfig& after);

/// Whether such a key may change while the daemon runs.
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

}  // namespace monitor
