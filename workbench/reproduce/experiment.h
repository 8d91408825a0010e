// Every experiment of the comparison, as data: a title and the function that runs it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "workbench/reproduce/row.h"

namespace workbench::reproduce {

struct Experiment {
  std::string_view title;
  std::vector<Row> (*run)();
};

/// In the order in which they are printed.
[[nodiscard]] std::span<const Experiment> experiments();

/// Runs them on up to `threads` threads. A line on standard error tells how far it got.
[[nodiscard]] std::vector<Section> run_all(std::span<const Experiment> which, unsigned threads);

std::vector<Row> printed_parameters();
std::vector<Row> structure_costs();
std::vector<Row> batch_against_recursive();
std::vector<Row> pressure_sensitivity();
std::vector<Row> damping_sensitivity();
std::vector<Row> case_one();
std::vector<Row> case_two();
std::vector<Row> isolation();
std::vector<Row> detection_delay();
std::vector<Row> rig_experiment();
std::vector<Row> needle_valve();

}  // namespace workbench::reproduce
