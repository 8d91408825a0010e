// A model parameter as a search sees it, under the name that fitting and diagnosing know it by.
#pragma once

#include "tracking/search_parameter.h"

namespace workbench::matching {

using tracking::effect_parameters;
using tracking::kEveryRefinement;
using tracking::plant_parameters;
using tracking::present_parameters;
using tracking::Scale;
using tracking::SearchParameter;
using tracking::start_of;

}  // namespace workbench::matching
