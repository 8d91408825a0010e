#include "workbench/simulate/scenario.h"

#include "config/schema/document.h"

namespace workbench::simulate {
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
