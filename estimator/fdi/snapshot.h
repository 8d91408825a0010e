// A pipeline's whole state as bytes that can be checked before they are used: of which
// configuration, at which sample, and whole.
//
//   "SWSTATE1", hash of the configuration, hash of the state, tick, length; then the state
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"

namespace estimator::fdi {

/// The text of a pipeline's configuration with nothing left in other files, sample time included.
[[nodiscard]] std::string whole_text(const PipelineConfig& config, double sample_time_s);

/// Replaces `out`. `tick`: of the sample that comes next. `config`: schema::hash_of(whole_text).
void save_snapshot(Pipeline& pipeline, std::uint64_t config, std::int64_t tick,
                   std::vector<std::uint8_t>& out);

/// Restores into a pipeline of the same configuration; returns the tick that comes next. Throws
/// schema::DataError at `where`; the pipeline is of no use then.
std::int64_t load_snapshot(std::span<const std::uint8_t> bytes, std::uint64_t config,
                           Pipeline& pipeline, const std::string& where);

}  // namespace estimator::fdi
