// What every step of a diagnosis works with: the model as it was given, the evidence, the effects
// that may be missing, and who wants to know how it goes.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "estimator/greybox/fit_dataset.h"
#include "estimator/greybox/free_parameter.h"
#include "plant_sim/library.h"
#include "plant_sim/model_file.h"

namespace estimator::greybox::selection {

/// What is being done, for a line that is renewed while it runs.
struct Progress {
  std::string doing;  ///< "round 1: trying friction"
  int done = 0;
  int of = 0;
  std::string best;  ///< the leading effect so far, may be empty
  double best_rms_m = 0.0;
  std::vector<std::string> expected;  ///< the quick look's ranking, once it is known
};

struct Workshop {
  plant_sim::ModelFile model;
  Evidence evidence;
  std::vector<plant_sim::EffectInfo> absent;  ///< effects that the plant can have and has not
  std::vector<SearchParameter> standing;      ///< the plant's and present effects' parameters
  unsigned threads = 2;
  std::function<void(const Progress&)>
      progress;                  ///< called from one thread at a time; may be empty
  std::function<bool()> cancel;  ///< asked from any thread; may be empty

  [[nodiscard]] bool cancelled() const { return cancel && cancel(); }
};

/// Effects that the plant can have and that are absent from the model, or neutral in it.
[[nodiscard]] std::vector<plant_sim::EffectInfo> absent_effects(const plant_sim::ModelFile& model);

[[nodiscard]] Workshop workshop(plant_sim::ModelFile model, Evidence evidence);

}  // namespace estimator::greybox::selection
