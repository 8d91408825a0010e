// Every experiment of the comparison, as data: a title and the function that runs it.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "workbench/reproduce/row.h"

namespace workbench::reproduce {

struct Experiment {
  std::string_view title;
  std::vector<ReproducedRow> (*run)();
};

/// In the order in which they are printed.
[[nodiscard]] std::span<const Experiment> experiments();

/// Runs them on up to `threads` threads. A line on standard error shows the progress.
[[nodiscard]] std::vector<ReproducedSection> run_all(std::span<const Experiment> which,
                                                     unsigned threads);

std::vector<ReproducedRow> printed_parameters();
std::vector<ReproducedRow> structure_costs();
std::vector<ReproducedRow> batch_against_recursive();
std::vector<ReproducedRow> pressure_sensitivity();
std::vector<ReproducedRow> damping_sensitivity();
std::vector<ReproducedRow> case_one();
std::vector<ReproducedRow> case_two();
std::vector<ReproducedRow> isolation();
std::vector<ReproducedRow> detection_delay();
std::vector<ReproducedRow> rig_experiment();
std::vector<ReproducedRow> needle_valve();

}  // namespace workbench::reproduce
