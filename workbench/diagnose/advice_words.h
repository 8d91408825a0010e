// Every sentence of the advice.
#pragma once

#include <string>
#include <vector>

#include "daemon/control/reference.h"
#include "estimator/greybox/selection/diagnosis.h"
#include "plant_sim/model_file.h"

namespace workbench::diagnose {

namespace selection = estimator::greybox::selection;

/// True where effects may enter there, on a plant of that name.
[[nodiscard]] bool has_site(const std::string& plant, const std::string& site);

/// "a multisine of 0.1 to 1.9 Hz within 38 mm of 305 mm for 30 s".
[[nodiscard]] std::string motion_words(const monitor::control::ReferenceConfig& reference,
                                       double duration_s);

[[nodiscard]] std::string words_for_motion(const std::vector<std::string>& names,
                                           const std::string& motion, double separation,
                                           bool tells_others);
/// A further measurement for the case that no motion helps, by where the effects act.
[[nodiscard]] std::string words_for_sensor(const plant_sim::ModelFile& model,
                                           const std::vector<std::string>& names);
[[nodiscard]] std::string words_to_excite(const std::string& motion);
/// The record to make and the formula to try, on a plant of that name.
[[nodiscard]] std::string words_for_unexplained(const std::vector<selection::Localisation>& where,
                                                const std::string& plant);

/// For readings that leap out of the motion, which a note lists.
[[nodiscard]] std::string words_for_leaps();
/// For effects found of which none is established.
[[nodiscard]] std::string words_for_doubt();
/// For changes within a record, or for differences between records.
[[nodiscard]] std::string words_for_changes(const std::vector<selection::ParameterChange>& changes);

}  // namespace workbench::diagnose
