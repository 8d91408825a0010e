// A model driven by the measured command, as fitting and diagnosing run it.
#pragma once

#include "daemon/tracking/model_run.h"
#include "workbench/matching/measured.h"
#include "workbench/matching/search_parameter.h"

namespace workbench::matching {

using monitor::tracking::kObserver_per_s;
using monitor::tracking::ModelRun;
using monitor::tracking::step_for;

}  // namespace workbench::matching
