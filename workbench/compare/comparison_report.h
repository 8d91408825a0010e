// A comparison as a report: what `spoolwatch compare --report` writes, and the sections that any
// report on a model against a measurement shares.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/validation/comparison.h"
#include "workbench/compare/disturbance_check.h"
#include "workbench/present/report.h"

namespace workbench::compare {

namespace validation = estimator::greybox::validation;

/// Over time; where it arises; against each variable; how it was computed. `prefix` keeps the zoom
/// groups of several comparisons in one report apart.
[[nodiscard]] std::vector<present::Section> sections(const validation::Comparison& comparison,
                                                     const std::string& prefix = "",
                                                     const DisturbanceCheck& check = {});

[[nodiscard]] present::Report make_report(const validation::Comparison& comparison,
                                          const std::string& command,
                                          const DisturbanceCheck& check = {});

/// At the floor: that of the sensor, or of sensor and disturbance.
enum class Judgement { at_floor, fails_somewhere, fails_throughout, useless };

/// Comparison as sentences: the verdict, then its support, most useful first.
struct Words {
  Judgement judgement = Judgement::fails_throughout;
  std::string verdict;             ///< one sentence or two
  std::vector<std::string> lines;  ///< further sentences, one thought each
};

[[nodiscard]] Words words(const validation::Comparison& comparison,
                          const DisturbanceCheck& check = {});

// A comparison for the terminal: words, numbers, a bar chart of where the error arises.

/// `unicode`: block characters, else ASCII. `all`: every variable's bins, not only the most
/// telling.
[[nodiscard]] std::string to_text(const validation::Comparison& comparison, bool unicode, bool all,
                                  const DisturbanceCheck& check = {});

// A comparison as JSON (SI; a missing number is null).

/// rms_m (drift-corrected), free_run_rms_m, fit_percent (of the free run), noise_floor_m,
/// one_step_rms_m, whiteness_p, independence_p, worst, and more. `worst`: the range of each
/// variable that stands out most, best first; `stands_out` is false where chance would do.
[[nodiscard]] std::string to_json(const validation::Comparison& comparison,
                                  const DisturbanceCheck& check = {});

/// Restrictions of the record: gaps, limited command, positions outside the stroke.
[[nodiscard]] std::vector<std::string> notes(const validation::Comparison& comparison);

}  // namespace workbench::compare
