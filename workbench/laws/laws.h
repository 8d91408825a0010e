// The laws of a model as curves, and the same seen in the samples of a record: speed over command,
// which is the flow through the valve, and resisting force over speed, which is friction and
// damping.
#pragma once

#include <string>
#include <vector>

#include "estimator/greybox/validation/comparison.h"
#include "plant_sim/model_file.h"

namespace workbench::laws {

struct LawCurve {
  std::vector<double> x, y;
};

struct Law {
  std::string title;
  std::string x_name, x_unit;  ///< as the axis that is printed has it; the values are in it
  std::string y_name, y_unit;
  LawCurve model;
  LawCurve samples;  ///< of the record; empty: it does not tell this law
  LawCurve mean;     ///< of the samples, over equal stretches of x
  std::string note;  ///< which samples, or why there are none
};

/// Laws of the model over the commands of the record that it was compared with, in the units of the
/// axis that is printed. Throws like steady_motion().
[[nodiscard]] std::vector<Law> laws_of(const plant_sim::ModelFile& model,
                                       const estimator::greybox::validation::Comparison& compared);

}  // namespace workbench::laws
