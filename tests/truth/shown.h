// The effects that a case hides, under the names and parameters of the product's library, and which
// of them a diagnosis can name.
#pragma once

#include <string>
#include <vector>

#include "tests/truth/record.h"

namespace truth {

/// One parameter of one effect: where it is kept, and how near a fit has to come.
struct Parameter {
  std::string effect;
  std::string name;
  double Hidden::*member;
  double tolerance;  ///< relative; 0: not scored (the record does not determine it by itself)
};

const std::vector<Parameter>& parameters();
/// The library's effects, each once.
const std::vector<std::string>& effects();
/// The effects of the case that are not neutral.
std::vector<std::string> hidden_effects(const Hidden& hidden);
/// The names that a diagnosis with the model of that kind (model_files.h) can give for what is
/// hidden. A cylinder shows those on command, opening and reading, and its areas as flow_asymmetry.
std::vector<std::string> shown_effects(const Case& of);
/// Further hidden effects, which that model has no place for.
std::vector<std::string> unshown_effects(const Case& of);
/// A parameter's true value, or what the cylinder's areas and load amount to.
double value_of(const Parameter& parameter, const Case& of);
/// The same with one effect taken out.
Case lacking(Case of, const std::string& effect);

}  // namespace truth
