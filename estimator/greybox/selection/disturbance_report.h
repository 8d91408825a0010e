// Disturbance of a rig, as far as a record with a model shows it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "estimator/greybox/selection/innovation_search.h"
#include "estimator/greybox/selection/structure_search.h"

namespace estimator::greybox::selection {

/// A kind of line that explains the record about as well in another's place.
struct LineRival {
  std::string as;
  double amplitude = 0.0;  ///< N, Pa, m; m/s
};

struct DisturbanceLine {
  std::string as;  ///< "force", "pressure", "sensor"; "speed" where the plant has no force
  double frequency_Hz = 0.0;
  double amplitude = 0.0;  ///< N, Pa, m; m/s
  double rms_m = 0.0;      ///< its part of the error of a simulation without friction or play
  std::vector<LineRival> rivals = {};  ///< as add_line_rivals() finds them
};

struct Disturbance {
  /// Kind of the random part: "force", "speed" where the plant has no force, or "reading" where
  /// most of it is a random walk of the position's reading.
  std::string as;
  double value = 0.0;      ///< RMS, N or m/s; of a reading m after one second; 0: only lines seen
  double corner_Hz = 0.0;  ///< below which most of it lies; 0 of a reading
  double rms_m = 0.0;      ///< part of the simulation's error, random part and lines together
  double share = 0.0;      ///< share of the final model's mean squared error
  std::vector<DisturbanceLine> lines;
  double random_m = 0.0;  ///< share of rms_m due to the random part
};

/// Nothing where what is found stays below the sensor's noise.
[[nodiscard]] std::optional<Disturbance> disturbance_of(const SearchContext& context,
                                                        const InnovationSearch& search);

/// Adds the kinds of line that the record does not tell from those found: to a plant that is linear
/// and stays as it is, a periodic force and a sensor that vibrates look alike.
void add_line_rivals(const SearchContext& plain, const InnovationStage& final,
                     Disturbance& disturbance);

/// Removes the random part where `step_error_m`, the error of the integration step, accounts for
/// it; resets `disturbance` where no line remains.
void drop_step_error(std::optional<Disturbance>& disturbance, double step_error_m);

/// Limits the disturbance and its lines to `rms_m`, the error that there is: friction and play let
/// less through than their linearised models do.
void limit(Disturbance& disturbance, double rms_m);

/// The search in the form of the other one, with held-out errors of simulations: a round for each
/// candidate taken, `p_value` of the likelihood ratio.
[[nodiscard]] StructureSearch structure_search_of(const SearchContext& context,
                                                  const ModelStage& first,
                                                  const InnovationSearch& search);

}  // namespace estimator::greybox::selection
