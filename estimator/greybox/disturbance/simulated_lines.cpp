#include "estimator/greybox/disturbance/simulated_lines.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "estimator/greybox/disturbance/model_ensemble.h"
#include "estimator/greybox/observer_correction.h"
#include "estimator/greybox/observer_simulation.h"

namespace estimator::greybox::disturbance {
namespace {

using plant_sim::Ensemble;

constexpr std::size_t kPlain = 0;
constexpr std::size_t kMoved = 1;

/// The sum of the lines at one moment, per site.
struct LineValues {
  double force = 0.0;  ///< N, or m/s where the plant has no force
  double supply_Pa = 0.0;
  double reading_m = 0.0;
};

LineValues values_at(double t_s, const std::vector<SpectralLine>& lines,
                     const std::vector<Eigen::Vector2d>& waves) {
  LineValues sum;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * lines[i].frequency_Hz * t_s;
    const double value = waves[i].dot(Eigen::Vector2d(std::sin(angle), std::cos(angle)));
    switch (lines[i].site) {
      case LineSite::force:
        sum.force += value;
        break;
      case LineSite::supply:
        sum.supply_Pa += value;
        break;
      case LineSite::sensor:
        sum.reading_m += value;
        break;
    }
  }
  return sum;
}

/// Correction by the weak observer: that of the lane without lines for both, or each lane's own.
enum class Correction { common, own };

Eigen::VectorXd moved_by_lines_m(const plant_sim::ModelFile& model, const Dataset& record,
                                 const std::vector<FreeParameter>& parameters,
                                 const Eigen::VectorXd& theta,
                                 const std::vector<SpectralLine>& lines,
                                 const std::vector<Eigen::Vector2d>& waves, double force_place,
                                 Correction correction) {
  const std::unique_ptr<Ensemble> ensemble =
      model_ensemble(model, record.sample_time_s, parameters, theta);
  ensemble->place_disturbance(force_place);
  const bool forces = ensemble->find("load_force.force_N").has_value();
  const auto supply = ensemble->find("supply_pressure_Pa");
  const double supply_Pa = supply ? ensemble->get(*supply, kPlain) : 0.0;
  Eigen::VectorXd moved_m(static_cast<Eigen::Index>(record.size()));
  const ObserverCorrection observer(*ensemble, record, kObserver_per_s);
  std::size_t segment = 0;
  for (std::size_t k = 0; k < record.size(); ++k) {
    const LineValues line = values_at(record.t_s[k], lines, waves);
    if (segment < record.starts.size() && record.starts[segment] == k) {
      // both lanes start from rest without lines
      if (supply) ensemble->set(*supply, kMoved, supply_Pa);
      ensemble->start(record.y_m[k]);
      ++segment;
    }
    const Ensemble::Values reading_m = ensemble->reading_m();
    const double now_m = reading_m[kMoved] - reading_m[kPlain] + line.reading_m;
    moved_m[static_cast<Eigen::Index>(k)] = now_m;
    Ensemble::Values error_m;
    error_m.fill(record.y_m[k] - reading_m[kPlain]);
    if (correction == Correction::own) {
      error_m[kMoved] = record.y_m[k] - reading_m[kMoved] - line.reading_m;
    }
    observer.apply(*ensemble, k, error_m);
    if (!forces) {
      Ensemble::Values moved{};
      moved[kMoved] = line.force * record.sample_time_s;
      ensemble->shift(moved);
    }
    Ensemble::Values force_N{};
    force_N[kMoved] = line.force;
    ensemble->disturb(force_N);
    if (supply) ensemble->set(*supply, kMoved, supply_Pa + line.supply_Pa);
    Ensemble::Values u_V;
    u_V.fill(record.u_V[k]);
    ensemble->advance(u_V, record.sample_time_s);
  }
  return moved_m;
}

}  // namespace

Eigen::VectorXd simulated_lines_m(const plant_sim::ModelFile& model, const Dataset& record,
                                  const std::vector<FreeParameter>& parameters,
                                  const Eigen::VectorXd& theta,
                                  const std::vector<SpectralLine>& lines,
                                  const std::vector<Eigen::Vector2d>& waves, double force_place) {
  return moved_by_lines_m(model, record, parameters, theta, lines, waves, force_place,
                          Correction::common);
}

Eigen::VectorXd simulated_line_error_m(const plant_sim::ModelFile& model, const Dataset& record,
                                       const std::vector<FreeParameter>& parameters,
                                       const Eigen::VectorXd& theta,
                                       const std::vector<SpectralLine>& lines,
                                       const std::vector<Eigen::Vector2d>& waves,
                                       double force_place) {
  return moved_by_lines_m(model, record, parameters, theta, lines, waves, force_place,
                          Correction::own);
}

}  // namespace estimator::greybox::disturbance
