#include "workbench/simulate/scenario.h"

#include "config/schema/document.h"

namespace workbench::simulate {

void Instruments::visit(config::schema::Visitor& v) {
  v.number({"encoder_resolution_m", "one step of the position encoder; 0: none"},
           encoder_resolution_m, {0.0, 1.0});
  v.number({"noise_m", "standard deviation of the position noise"}, noise_m, {0.0, 1.0});
  v.integer({"dac_bits", "resolution of the D/A converter; 0: no steps"}, dac_bits, {0, 32});
  v.number({"dac_range_V", "the D/A converter gives -range to +range"}, dac_range_V,
           {1e-3, 1000.0});
  v.number({"pressure_noise_Pa", "standard deviation of each pressure's noise"}, pressure_noise_Pa,
           {0.0, 1e9});
}

void Scenario::visit(config::schema::Visitor& v) {
  model.visit(v);
  v.table({"reference", "the motion asked for"},
          [&](config::schema::Visitor& t) { reference.visit(t); });
  v.table({"instruments", "encoder, noise and D/A converter"},
          [&](config::schema::Visitor& t) { instruments.visit(t); });
  visit_list(v, {"fault", "changes of parameters at scheduled times"}, faults);
  visit_list(v, {"sensor_fault", "faults of the position sensor"}, sensor_faults);
}

Scenario read_scenario(const config::schema::Document& document) {
  Scenario scenario;
  document.read([&](config::schema::Visitor& v) { scenario.visit(v); });
  // The checks between a model's values are where models are read.
  scenario.model = plant_sim::read_model(
      config::schema::Document::parse(plant_sim::print_model(scenario.model), document.name()));
  scenario.folder = document.folder();
  return scenario;
}

}  // namespace workbench::simulate
