// b1 with the parameters as printed, and with the valve constant solved for the printed b1.
#include "estimator/batch.h"
#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/thesis_scenarios.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

constexpr double kPrintedB1 = 1.9672e-4;

double fifth_period_b1(const Scenario& scenario) {
  const ScenarioRecord record = run(scenario, 10.0);
  const auto periods =
      estimator::fit_periods(estimator::parse_structure("arx111"), record.u_V, record.y_m, kPeriod);
  return periods.at(4).value[1];
}

}  // namespace

std::vector<ReproducedRow> printed_parameters() {
  return {judged("b1 of ARX111, parameters as printed, m/V", kPrintedB1,
                 fifth_period_b1(shipped("thesis")), "mean b1, as printed",
                 "outside every printed band: the printed valve constant 2.79e-5 m/V cannot be "
                 "the one used"),
          judged("b1 of ARX111, valve constant calibrated, m/V", kPrintedB1,
                 fifth_period_b1(calibrated()), "mean b1", "the valve constant was solved for it")};
}

}  // namespace workbench::reproduce
