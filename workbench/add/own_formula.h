// A formula that is typed or learned, as an effect of a model: "force: c*v_mps^3" with c=1e5.
#pragma once

#include <string>
#include <vector>

#include "workbench/add/added_effect.h"

namespace workbench::add {

/// The model of `file` with the formula `text`, "SITE: EXPRESSION", and the rate of its memory z
/// (empty: none) declared as `name` (empty: own_SITE) and present. Each parameter of the expression
/// is given in `assignments`, above or below 0; its range and neutral value are chosen about that
/// size so that the formula stays finite, and has no influence where all are neutral. Throws
/// config::schema::UsageError for a formula that the model cannot have.
[[nodiscard]] AddedEffect add_formula(const std::string& file, const std::string& text,
                                      const std::string& memory, const std::string& name,
                                      const std::vector<std::string>& assignments);

/// The model of `file` with law number `number` (from 1) of a diagnosis's JSON, at the values that
/// were fitted, or those of `assignments`. `name`: empty for the law's own. Throws
/// config::schema::UsageError as above or where there is no such law, DataError for a file that is
/// no diagnosis.
[[nodiscard]] AddedEffect add_law(const std::string& file, const std::string& diagnosis, int number,
                                  const std::string& name,
                                  const std::vector<std::string>& assignments);

}  // namespace workbench::add
