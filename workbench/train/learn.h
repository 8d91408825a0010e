// Training of the sources of a configuration that need it, from records: means,
// covariances and long-run deviations of block means, made by the same blocks as on line
// (block_method.h).
//
//   long_run^2 = c0 + 2 sum over l = 1..L of (1 - l/(L + 1)) c_l,   L = floor(4 (n/100)^(2/9))
//
// c_l: autocovariance of the block means at lag l, within records; never less than c0, since a
// test's false alarms come from both. It is multiplied by 1 + 1.645/sqrt(2 n), its upper 95 % limit
// for n blocks.
// Source: W. K. Newey, K. D. West, Econometrica 55 (1987) 703; L: Review of Economic Studies 61
// (1994) 631.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/record/record.h"
#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/trained.h"

namespace workbench::train {

/// Records of one kind.
struct Teaching {
  std::string name;            ///< estimator::fdi::TrainedFile::kHealthy, or what has changed
  std::int64_t direction = 0;  ///< in which it has
  std::vector<config::record::Record> records;
};

/// Block means, one row a block, record by record.
using Blocks = std::vector<std::vector<std::vector<double>>>;

/// Summarises n blocks of d values. Throws schema::DataError at `where` for n below twenty, or
/// below three for each value.
[[nodiscard]] estimator::fdi::TrainedClass summarise(const Blocks& blocks, const Teaching& teaching,
                                                     const std::string& where);

/// `file`: of the configuration, for messages. The first of `teachings` is healthy; sources that
/// need no classes learn from that alone. Throws schema::ConfigError when nothing in the
/// configuration is trained, DataError for records too short or of different sample times.
[[nodiscard]] estimator::fdi::TrainedFile learn(const estimator::fdi::PipelineConfig& pipeline,
                                                const std::vector<Teaching>& teachings,
                                                const std::string& rig_id, const std::string& file);

}  // namespace workbench::train
