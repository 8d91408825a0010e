// A model linearised about its own trajectory: how a small change of state, disturbance or supply
// pressure at one sample arrives at the next.
//
//   x(k+1) = A(k) x(k) + b_p(k) dPs(k),   x = (y, v, Pi, Po, z, z', F)  or what the plant has of it
//
// by difference quotients of the plant's own step, all in the lanes of ensembles. y: position at
// the sensor, that of the rod without a second mass; z, z': offset of the second mass and its rate.
// Spool states are left out: the command determines them. Dry friction and play are switched off
// for the quotients: a slope across stick and slip says nothing.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "estimator/greybox/dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/coupled_step.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::disturbance {

inline constexpr Eigen::Index kMostStates = 7;  ///< F included
using StateVector = Eigen::Matrix<double, kMostStates, 1>;
using StateMatrix = Eigen::Matrix<double, kMostStates, kMostStates>;

/// One entry per sample of a record. Rows and columns beyond the plant's states are zero; F is the
/// last of kMostStates. A's row of F is zero: the noise model says how F decays.
struct Linearisation {
  std::vector<std::string> states;  ///< without F
  bool force = false;               ///< F is a force, N; otherwise a speed, m/s
  bool supply = false;              ///< the plant has a supply pressure
  /// As plant_sim::Ensemble::place_disturbance().
  double force_place = plant_sim::kPlaceOfSensor;
  std::vector<StateMatrix> transition;
  std::vector<StateVector> from_supply;  ///< per Pa; zero without a supply pressure
  std::vector<double> speed_mps;
  /// How far the rod has yet to move until the sensor's play passes its motion on, m; negative
  /// where it does. Empty: no play, or a record without innovations.
  std::vector<double> gap_m;
};

/// Start of the plant that has these states.
[[nodiscard]] PlantStart start_of(const std::vector<std::string>& states);

/// About the simulation with `theta` (weak observer). Throws as ObserverSimulation does.
[[nodiscard]] Linearisation linearise(const plant_sim::ModelFile& model, const Dataset& record,
                                      const std::vector<FreeParameter>& parameters,
                                      const Eigen::VectorXd& theta,
                                      double force_place = plant_sim::kPlaceOfSensor);

inline constexpr const char* kPlayWidth = "backlash.width_m";
/// True for a model with a play between rod and sensor.
[[nodiscard]] bool has_play(const plant_sim::ModelFile& model,
                            const std::vector<FreeParameter>& parameters,
                            const Eigen::VectorXd& theta);

}  // namespace estimator::greybox::disturbance
