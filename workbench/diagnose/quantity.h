// Numbers as an engineer reads them: in the unit of the size, rounded to what is known of them.
#pragma once

#include "daemon/tracking/quantity.h"

namespace workbench::diagnose {

using monitor::tracking::chance_words;
using monitor::tracking::length_words;
using monitor::tracking::number;
using monitor::tracking::parameter_words;
using monitor::tracking::quantity;
using monitor::tracking::Quantity;
using monitor::tracking::times_words;
using monitor::tracking::typeset;
using monitor::tracking::words;

}  // namespace workbench::diagnose
