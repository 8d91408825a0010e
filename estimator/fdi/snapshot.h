// A pipeline's complete state as bytes, with a header that identifies configuration and sample and
// detects damage.
//
//   "SWSTATE1", hash of the configuration, hash of the state, tick, length; then the state
#pragma once

#include <cstdint>
#include <span>
#include <string>
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

}  // namespace estimator::fdi
