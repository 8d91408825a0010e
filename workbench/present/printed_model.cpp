#include "workbench/present/printed_model.h"

#include "config/units/quantity.h"

namespace workbench::present {

void print_as(const plant_sim::ModelFile& model) {
  using config::units::Motion;
  config::units::set_motion(model.rotary() ? Motion::rotary : Motion::linear);
}

plant_sim::ModelFile load_printed_model(const std::filesystem::path& file,
                                        const std::vector<std::string>& assignments) {
  plant_sim::ModelFile model = plant_sim::load_model(file, assignments);
  print_as(model);
  return model;
}

}  // namespace workbench::present
