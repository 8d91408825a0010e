#include "estimator/greybox/selection/typical_sizes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "plant_sim/library.h"

namespace estimator::greybox::selection {
namespace {

/// Typical size of a parameter of friction on an axis that moves so far.
double typical(const std::string& name, double stroke_m) {
  const plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                           "/config/models/force_driven_axis.toml");
  Dataset record;
  record.name = "made";
  record.sample_time_s = 0.005;
  for (std::size_t k = 0; k < 2000; ++k) {
    const double t_s = 0.005 * static_cast<double>(k);
    record.t_s.push_back(t_s);
    record.u_V.push_back(4.0 * std::sin(3.0 * t_s));
    record.y_m.push_back(stroke_m * std::sin(3.0 * t_s));
    record.valid.push_back(1);
  }
  record.starts = {0};
  std::vector<plant_sim::EffectInfo> effects = plant_sim::effects_of(model);
  scale_typical_sizes(model, fit_dataset({record}, {}), effects);
  for (const plant_sim::EffectInfo& effect : effects) {
    if (effect.name != "friction") continue;
    for (const plant_sim::ParameterInfo& parameter : effect.parameters) {
      if (parameter.name == name) return parameter.typical;
    }
  }
  return std::nan("");
}

// Bristles yield over micrometres; speeds go with the stroke.
TEST(TypicalSizes, ABristlesStiffnessDoesNotGoWithTheStroke) {
  EXPECT_DOUBLE_EQ(typical("presliding_stiffness_N_per_m", 0.001),
                   typical("presliding_stiffness_N_per_m", 1.0));
  EXPECT_GT(typical("stribeck_mps", 1.0), 10.0 * typical("stribeck_mps", 0.001));
}

}  // namespace
}  // namespace estimator::greybox::selection
