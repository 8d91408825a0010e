// Faults and other changes of a plant's parameters at scheduled times (change.h).
#pragma once

#include <cstddef>
#include <vector>

#include "plant_sim/change.h"
#include "plant_sim/plant.h"

namespace plant_sim {

class Schedule {
 public:
  Schedule() = default;
  /// The plant must outlive the schedule. Several changes of one parameter follow each other.
  /// Throws config::schema::ConfigError for an unknown parameter and like target_of().
  Schedule(std::vector<Change> changes, Plant& plant);

  /// Advances the plant from t_s over duration_s with u_V held. A change takes effect at the first
  /// integration step that does not begin before its time; a ramp is linear from the value found
  /// then, updated at every integration step. Times must not go back.
  void advance(Plant& plant, double u_V, double t_s, double duration_s) noexcept;

 private:
  struct Entry {
    double* target;
    double at_s;
    double ramp_s;
    double time_constant_s;
    double from;
    double to;
    bool started;
    bool done;
  };
  /// Applies the changes due at t_s; returns the time of the next one (infinite: none).
  double apply(double t_s) noexcept;

  std::vector<Entry> entries_;  ///< in the order of at_s
  std::size_t next_ = 0;        ///< index of the first pending entry
};

}  // namespace plant_sim
