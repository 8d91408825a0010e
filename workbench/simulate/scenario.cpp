#include "workbench/simulate/scenario.h"

#include <algorithm>

#include "config/schema/document.h"

namespace workbench::simulate {
namespace {

/// The motion that is asked for by default, moved into a stroke that it would leave.
void keep_within_stroke(plant_sim::ModelFile& model, monitor::control::ReferenceConfig& reference) {
  constexpr double kOfStroke = 0.2;
  const double* stroke_m = model.value("stroke_m");
  if (stroke_m == nullptr || reference.centre_m + reference.amplitude_m < *stroke_m) return;
  reference.centre_m = 0.5 * *stroke_m;
  reference.amplitude_m = std::min(reference.amplitude_m, kOfStroke * *stroke_m);
}

}  // namespace

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
  document.read_part([&](config::schema::Visitor& v) { scenario.model.visit(v); });
  keep_within_stroke(scenario.model, scenario.reference);
  document.read([&](config::schema::Visitor& v) { scenario.visit(v); });
  // The checks between a model's values are where models are read.
  scenario.model = plant_sim::read_model(
      config::schema::Document::parse(plant_sim::print_model(scenario.model), document.name()));
  scenario.folder = document.folder();
  return scenario;
}

}  // namespace workbench::simulate
