#include "workbench/diagnose/search_rounds.h"

#include <algorithm>

namespace workbench::diagnose {

std::vector<std::string> taken_in(const selection::StructureSearch& search, std::size_t round) {
  const std::vector<std::string>& before = search.rounds[round].before.added;
  const std::vector<std::string>& after =
      round + 1 < search.rounds.size() ? search.rounds[round + 1].before.added : search.final.added;
  std::vector<std::string> taken;
  for (const std::string& effect : after) {
    if (std::find(before.begin(), before.end(), effect) == before.end()) taken.push_back(effect);
  }
  return taken;
}

bool stayed(const selection::StructureSearch& search, const std::vector<std::string>& effects) {
  const std::vector<std::string>& final = search.final.added;
  return std::any_of(effects.begin(), effects.end(), [&](const std::string& effect) {
    return std::find(final.begin(), final.end(), effect) != final.end();
  });
}

std::size_t deciding_round(const selection::StructureSearch& search) {
  for (std::size_t i = search.rounds.size(); i-- > 0;) {
    if (stayed(search, taken_in(search, i))) return i;
  }
  return search.rounds.size() - 1;
}

}  // namespace workbench::diagnose
