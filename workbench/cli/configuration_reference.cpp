#include "workbench/cli/command.h"

#include "config/schema/reference.h"
#include "estimator/fdi/learned_bands.h"
#include "estimator/fdi/tracker/baseline_file.h"
#include "estimator/fdi/trained.h"
#include "workbench/scorecard/method.h"
#include "workbench/scorecard/plan.h"
#include "workbench/simulate/scenario.h"

namespace workbench::cli {
namespace {

template <class T>
std::string section(const std::string& heading, const std::string& text) {
  return "\n## " + heading + "\n\n" + text + "\n" +
         config::schema::print_reference([](config::schema::Visitor& v) { T().visit(v); });
}

/// The section up to its second table.
std::string first_table(const std::string& section) {
  const std::string heading = "\n### ";
  return section.substr(0, section.find(heading, section.find(heading) + heading.size()));
}

}  // namespace

std::string configuration_reference() {
  return section<simulate::Scenario>(
             "Model file",
             "Read by `compare`, `diagnose`, `fit` and all other commands that take a model; "
             "`[reference]`,\n`[instruments]`, `[[fault]]` and `[[sensor_fault]]` by `simulate` "
             "alone.") +
         section<estimator::fdi::LearnedBands>(
             "Learned bands", "Written by `calibrate` and `promote`, named by `bands_file`.") +
         section<estimator::fdi::TrainedFile>(
             "Trained methods", "Written by `train`, named by `file` of the methods that learn.") +
         section<estimator::fdi::tracker::BaselineFile>(
             "Healthy parameters",
             "Written by `isolate --learn`, named by `healthy` of `[[tracker]]`.") +
         section<scorecard::Plan>("Scorecard plan", "Read by `scorecard --plan`.") +
         first_table(section<scorecard::Method>(
             "Scorecard method",
             "Read by `scorecard`. The tables of its fault detection are those of the daemon."));
}

}  // namespace workbench::cli
