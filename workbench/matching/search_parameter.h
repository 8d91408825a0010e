// A model parameter as a search sees it, under the name that fitting and diagnosing know it by.
#pragma once

#include "daemon/tracking/search_parameter.h"

namespace workbench::matching {

using monitor::tracking::effect_parameters;
using monitor::tracking::kEveryRefinement;
using monitor::tracking::plant_parameters;
using monitor::tracking::present_parameters;
using monitor::tracking::Scale;
using monitor::tracking::SearchParameter;
using monitor::tracking::start_of;

}  // namespace workbench::matching
