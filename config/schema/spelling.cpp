#include "config/schema/spelling.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "config/schema/error.h"
#include "config/schema/joined.h"

namespace config::schema {

std::string nearest(std::string_view typed, const std::vector<std::string>& names) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, typed.size() / 3) + 1;
  for (const std::string& name : names) {
    std::vector<std::size_t> row(name.size() + 1);
    std::iota(row.begin(), row.end(), 0U);
    for (std::size_t i = 0; i < typed.size(); ++i) {
      std::size_t diagonal = row[0];
      row[0] = i + 1;
      for (std::size_t j = 0; j < name.size(); ++j) {
        const std::size_t substitute = diagonal + (typed[i] == name[j] ? 0U : 1U);
        diagonal = row[j + 1];
        row[j + 1] = std::min({substitute, row[j] + 1, row[j + 1] + 1});
      }
    }
    if (row.back() < best_distance) {
      best_distance = row.back();
      best = name;
    }
  }
  return best;
}

void require_known_options(const std::vector<std::string>& words,
                           const std::vector<std::string>& options, const std::string& place) {
  for (const std::string& word : words) {
    if (word == "--") return;
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    if (std::find(options.begin(), options.end(), name) != options.end()) continue;
    std::vector<std::string> near;
    std::copy_if(options.begin(), options.end(), std::back_inserter(near),
                 [&](const std::string& option) { return option.starts_with(name); });
    if (near.empty()) near.push_back(nearest(name, options));
    throw UsageError(place + "option " + name + " is unknown" +
                     (near.front().empty() ? "" : ", did you mean " + joined(near, " or ") + "?"));
  }
}

}  // namespace config::schema
