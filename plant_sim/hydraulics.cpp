#include "plant_sim/hydraulics.h"

#include "plant_sim/plants.h"

namespace plant_sim {

std::optional<Hydraulics> hydraulics_of(const ModelFile& model) {
  std::optional<Hydraulics> found;
  each_plant<double>([&]<class Model>() {
    if constexpr (requires { typename Model::PlantDesign; }) {
      if (model.plant != Model::kName) return;
      using Design = typename Model::PlantDesign;
      typename Model::Parameters p;
      p.visit([&](const ParameterInfo& info, double& value) {
        for (const NamedValue& given : model.parameters) {
          if (given.name == info.name) value = given.value;
        }
      });
      const CylinderSide<double> in = Design::in_side(p);
      found = {in.area_m2, p.supply_pressure_Pa, Design::spool(p, model.step_s).gain_m_per_V,
               in.orifice, Design::kGainParameter};
    }
  });
  return found;
}

}  // namespace plant_sim
