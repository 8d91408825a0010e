// The kinds of sources that know physics, for PipelineConfig: [[tracker]] (tracker_config.h).
#pragma once

#include <span>

#include "estimator/fdi/source.h"

namespace estimator::fdi::tracker {

[[nodiscard]] std::span<const estimator::fdi::SourceKind> source_kinds() noexcept;

}  // namespace estimator::fdi::tracker
