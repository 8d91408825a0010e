// Sets of records for judging the diagnosis.
//
//   single   every effect of the library in turn (friction as Coulomb, with Stribeck, with
//            pre-sliding), on motions that rotate; half of them mismatched
//   healthy  nothing hidden, every motion, half mismatched
//   pairs    two effects of different classes that physics can tell apart
//   leftout  one effect that the library does not have
//   disturbed, disturbed_healthy   single and healthy under a random force, a pulsating supply, a
//            shaking sensor mount, or two of these
//   axes         electric axes, linear and rotary: eleven singles or nothing, pairs, and an elastic
//                shaft, which the library does not have; every second dozen disturbed
//   conditions   singles and healthy records under each of conditions.h by turns
//   single_rods  single-rod cylinders, to be diagnosed as a servo known by command and position
//   mismatch20   singles with every value of the plant up to 20 % off
//   outside_laws leftout, disturbed
//   repeated     singles and healthy ones on a motion with a period, disturbed
//
// Sizes are drawn log-uniform within a factor of two of a typical one. A draw that hardly shows
// (visibility.h), leaves the stroke or runs into cavitation is drawn anew, larger or on the next
// motion; after eight draws the best one stays, and the answer says how visible it is.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/truth/record.h"

namespace truth {

/// A planned record with its answer.
struct Planned {
  Case of;
  std::string text;                 ///< parse_case(text, of.seed) makes it again
  std::vector<std::string> hidden;  ///< effects of the library
  std::vector<double> visibility;   ///< one of each effect, or of the left-out one
  std::string condition;            ///< empty: none
  bool within_limits = true;        ///< pressures between 0 and supply, rod within the stroke
};

const std::vector<std::string>& plans();
/// Record `index` of a plan; throws std::invalid_argument for an unknown plan.
Planned plan_record(const std::string& plan, std::size_t seed, std::size_t index, Record& record);
/// Writes the CSV files and answers.json into a folder that exists.
void write_plan(const std::string& plan, std::size_t count, std::size_t seed,
                const std::string& folder, int jobs);
/// answers.json of write_plan; the records in the order of their numbers.
void write_answers(const std::string& file, const std::string& plan, std::size_t seed,
                   const std::vector<Planned>& planned, const std::vector<double>& floors_m);
/// case0007.csv
std::string file_name(std::size_t index);

}  // namespace truth
