// A pipeline's complete state as bytes, with a header that identifies configuration and sample and
// detects damage.
//
//   "SWSTATE1", hash of the configuration, hash of the state, tick, length; then the state
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/fdi/pipeline.h"

namespace estimator::fdi {

/// Text of a pipeline's complete configuration, with the contents of referenced files and the
/// sample time.
[[nodiscard]] std::string whole_text(const PipelineConfig& config, double sample_time_s);

/// Replaces `out`. `tick`: of the next sample. `config`: schema::hash_of(whole_text).
void save_snapshot(Pipeline& pipeline, std::uint64_t config, std::int64_t tick,
                   std::vector<std::uint8_t>& out);

/// Restores into a pipeline of the same configuration; returns the next tick. Throws
/// schema::DataError at `where`; the pipeline is unusable then.
std::int64_t load_snapshot(std::span<const std::uint8_t> bytes, std::uint64_t config,
                           Pipeline& pipeline, const std::string& where);

/// Settings as one line, to compare and to show.
/// Printed TOML without schema_version and id.
[[nodiscard]] inline std::string one_line(std::string toml) {
  toml.erase(0, toml.find('\n') + 1);  // schema_version
  if (toml.starts_with("id = ")) toml.erase(0, toml.find('\n') + 1);
  for (char& c : toml) {
    if (c == '\n') c = ' ';
    if (c == '"') c = '\'';
  }
  while (!toml.empty() && toml.back() == ' ') toml.pop_back();
  return toml;
}

/// The first setting in which two such lines differ, "[table] key = value"; "none" where a line
/// lacks it.
struct FingerprintDifference {
  std::string found;
  std::string expected;
};
[[nodiscard]] FingerprintDifference difference(std::string_view found, std::string_view expected);

}  // namespace estimator::fdi
