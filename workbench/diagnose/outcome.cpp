#include "workbench/diagnose/outcome.h"

#include <algorithm>

namespace workbench::diagnose {

namespace greybox = estimator::greybox;
namespace selection = estimator::greybox::selection;

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

VectorXd run(const selection::Workshop& shop, const std::vector<greybox::SearchParameter>& searched,
             const VectorXd& x, double observer_per_s) {
  greybox::EvidenceRun runs(shop.model, shop.evidence, searched, observer_per_s);
  MatrixXd residuals_m;
  runs.residuals(x, residuals_m);
  return residuals_m.col(0);
}

}  // namespace

VectorXd residual_of_file_m(const selection::Workshop& shop, double observer_per_s) {
  return run(shop, shop.standing, greybox::start_of(shop.model, shop.standing), observer_per_s);
}

VectorXd residual_of_m(const selection::Workshop& shop, const greybox::Fitted& fitted,
                       double observer_per_s) {
  return run(shop, fitted.searched, fitted.x, observer_per_s);
}

void simulate_freely(Outcome& outcome) {
  if (!outcome.fitted()) return;
  const selection::Workshop& shop = outcome.shop;
  outcome.free_run_before_m = greybox::rms(residual_of_file_m(shop, 0.0), shop.evidence.counts);
  outcome.free_run_after_m =
      greybox::rms(residual_of_m(shop, outcome.diagnosis.final, 0.0), shop.evidence.counts);
}

std::vector<std::string> taken_in(const selection::Ladder& ladder, std::size_t round) {
  const std::vector<std::string>& before = ladder.rounds[round].before.added;
  const std::vector<std::string>& after =
      round + 1 < ladder.rounds.size() ? ladder.rounds[round + 1].before.added : ladder.final.added;
  std::vector<std::string> taken;
  for (const std::string& effect : after) {
    if (std::find(before.begin(), before.end(), effect) == before.end()) taken.push_back(effect);
  }
  return taken;
}

bool stayed(const selection::Ladder& ladder, const std::vector<std::string>& effects) {
  const std::vector<std::string>& final = ladder.final.added;
  return std::any_of(effects.begin(), effects.end(), [&](const std::string& effect) {
    return std::find(final.begin(), final.end(), effect) != final.end();
  });
}

std::size_t deciding_round(const selection::Ladder& ladder) {
  for (std::size_t i = ladder.rounds.size(); i-- > 0;) {
    if (stayed(ladder, taken_in(ladder, i))) return i;
  }
  return ladder.rounds.size() - 1;
}

}  // namespace workbench::diagnose
