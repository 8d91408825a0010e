#include "workbench/present/printed_axis.h"

namespace workbench::present {

config::units::Motion motion_of(const plant_sim::ModelFile& model) {
  return model.rotary() ? config::units::Motion::rotary : config::units::Motion::linear;
}

}  // namespace workbench::present
