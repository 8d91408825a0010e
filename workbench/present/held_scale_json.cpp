#include "workbench/present/held_scale_json.h"

namespace workbench::present {

nlohmann::ordered_json json_of(const estimator::greybox::HeldScale& held) {
  if (held.parameter.empty()) return nullptr;
  return {{"parameter", held.parameter},
          {"also_held", held.also_held},
          {"scaled", held.scaled},
          {"inverse", held.inverse}};
}

}  // namespace workbench::present
