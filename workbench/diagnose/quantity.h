// Numbers as an engineer reads them: in the unit of the size, rounded to what is known of them.
#pragma once

#include "tracking/quantity.h"

namespace workbench::diagnose {

using tracking::chance_words;
using tracking::length_words;
using tracking::number;
using tracking::parameter_words;
using tracking::quantity;
using tracking::Quantity;
using tracking::times_words;
using tracking::typeset;
using tracking::words;

}  // namespace workbench::diagnose
