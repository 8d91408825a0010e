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
struct Rules {
  estimator::fdi::PipelineConfig effective;
  std::unique_ptr<estimator::fdi::Pipeline> pipeline;
  std::string text;  ///< fdi::whole_text
};

/// Throws config::schema::Error (exit 78) that names the file.
[[nodiscard]] Rules make_rules(const DaemonConfig& config, double sample_time_s);

/// The files that evidence needs to be read by itself; `rules_text`: Rules::text.
[[nodiscard]] std::vector<io::EvidenceFile> evidence_files(DaemonConfig& config,
                                                           const std::string& rules_text);

/// "[[band]] gain: high", ... of what differs between two configurations.
[[nodiscard]] std::vector<std::string> differences(DaemonConfig& before, DaemonConfig& after);

/// Whether such a key may change while the daemon runs.
[[nodiscard]] bool may_change(const std::string& key,
                              const estimator::fdi::PipelineConfig& pipeline);

/// What `make` returns. A configuration error (exit 78) in it gets `place` put before its text.
template <class Make>
auto with_place(const std::string& place, const Make& make) {
  using config::schema::Error;
  using config::schema::ExitCode;
  try {
    return make();
  } catch (const Error& error) {
    if (error.exit_code() != static_cast<int>(ExitCode::bad_config)) throw;
    throw Error(ExitCode::bad_config, place + ": " + error.what());
  }
}

}  // namespace monitor
