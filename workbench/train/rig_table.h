// [rig] of a daemon's configuration, for commands that read only a part of it.
#pragma once

#include <string>

#include "config/schema/visitor.h"

namespace workbench::train {

/// `rig_id` stays as it is where the file says nothing.
inline void visit_rig(config::schema::Visitor& v, std::string& rig_id) {
  v.table({"rig", "identity of the rig"}, [&](config::schema::Visitor& rig) {
    std::string calibration;
    rig.text({"id", "name of the rig"}, rig_id);
    rig.text({"calibration", "file that commissioning wrote"}, calibration);
  });
}

}  // namespace workbench::train
