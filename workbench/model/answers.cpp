// Checks of the numbers that a model file is made of: each by itself, against each other, and as
// the parameters that follow from them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "config/schema/error.h"
#include "config/schema/joined.h"
#include "plant_sim/library.h"
#include "workbench/model/kinds.h"
#include "workbench/model/model_writer.h"

namespace workbench::model {
namespace {

using config::schema::UsageError;

struct Range {
  double least, most;
  [[nodiscard]] bool has(double value) const { return value >= least && value <= most; }
};

struct OutOfRange {
  std::string parameter;
  double value;
  Range allowed;
};

double value_of(const Kind& kind, const Answers& all, const std::string& parameter) {
  ModelWriter w("");
  kind.write(all, w);
  for (const auto& [name, value] : w.values()) {
    if (name == parameter) return value;
  }
  return std::nan("");
}

/// The first parameter of the model that its plant does not allow.
std::optional<OutOfRange> out_of_range(const Kind& kind, const Answers& all) {
  ModelWriter w("");
  kind.write(all, w);
  const plant_sim::PlantInfo& plant = *plant_sim::find_plant(w.plant());
  for (const auto& [name, value] : w.values()) {
    for (const plant_sim::ParameterInfo& info : plant.parameters) {
      const Range allowed{info.min, info.max};
      if (name == info.name && !allowed.has(value)) return OutOfRange{name, value, allowed};
    }
  }
  return std::nullopt;
}

/// Values of one answer, the others as they are, that bring the parameter into its range.
std::optional<Range> allowed_answers(const Kind& kind, Answers all, const Question& q,
                                     const OutOfRange& found) {
  constexpr int kTried = 300;
  constexpr double kLeastShare = 1e-9;  // of a range that begins at or under 0
  const auto fits = [&](double x) {
    all[q.flag] = x;
    return found.allowed.has(value_of(kind, all, found.parameter));
  };
  const double from = q.min > 0.0 ? q.min : q.max * kLeastShare;
  const auto tried = [&](int i) {
    return i == kTried ? q.max : from * std::pow(q.max / from, static_cast<double>(i) / kTried);
  };
  const auto edge = [&](double good, double bad) {
    for (int i = 0; i < 60; ++i) {
      const double x = 0.5 * (good + bad);
      (fits(x) ? good : bad) = x;
    }
    return good;
  };
  int first = 0;
  while (first <= kTried && !fits(tried(first))) ++first;
  if (first > kTried) return std::nullopt;
  int last = first;
  while (last < kTried && fits(tried(last + 1))) ++last;
  const double least = first > 0     ? edge(tried(first), tried(first - 1))
                       : fits(q.min) ? q.min
                                     : tried(first);
  return Range{least, last < kTried ? edge(tried(last), tried(last + 1)) : tried(last)};
}

/// Four digits, towards the inside of the range.
Range rounded(const Range& range) {
  const auto to = [](double value, auto&& round) {
    if (value == 0.0) return value;
    const double digit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3.0);
    return round(value / digit) * digit;
  };
  return {to(range.least, [](double x) { return std::ceil(x - 1e-6); }),
          to(range.most, [](double x) { return std::floor(x + 1e-6); })};
}

void check_parameters(const Kind& kind, const Answers& all) {
  const std::optional<OutOfRange> found = out_of_range(kind, all);
  if (!found) return;
  std::vector<std::string> ways;
  for (const Question& q : kind.questions) {
    const std::optional<Range> allowed = allowed_answers(kind, all, q, *found);
    if (!allowed) continue;
    const Range shown = rounded(*allowed);
    ways.push_back(fmt::format("--{} (is {:g}; allowed: {:g} to {:g})", q.flag, all.at(q.flag),
                               shown.least, shown.most));
  }
  throw UsageError(fmt::format(
      "new {}: {} would be {:.4g}, allowed: {:g} to {:g}; change {}", kind.name, found->parameter,
      found->value, found->allowed.least, found->allowed.most,
      ways.empty() ? "more than one of the numbers" : config::schema::joined(ways, " or ")));
}

}  // namespace

void check_answers(const Kind& kind, const Answers& answers) {
  std::vector<std::string> flags;
  std::vector<std::string> missing;
  for (const Question& q : kind.questions) {
    flags.push_back("--" + q.flag);
    const auto given = answers.find(q.flag);
    if (given == answers.end()) {
      if (std::isnan(q.usual)) missing.push_back("--" + q.flag + " (" + q.what + ")");
      continue;
    }
    questions::check_range("new " + kind.name, q, given->second);
  }
  for (const auto& [flag, value] : answers) {
    if (std::find(flags.begin(), flags.end(), "--" + flag) != flags.end()) continue;
    throw UsageError("new " + kind.name + ": --" + flag +
                     " is not asked of this kind; allowed: " + config::schema::joined(flags));
  }
  if (!missing.empty()) {
    throw UsageError("new " + kind.name + ": lacks " + config::schema::joined(missing));
  }
  const auto bore = answers.find("bore-mm");
  const auto rod = answers.find("rod-mm");
  if (bore != answers.end() && rod != answers.end() && rod->second >= bore->second) {
    throw UsageError(
        fmt::format("new {}: --rod-mm is {:g}, no rod for --bore-mm {:g}; allowed: 1 to less than "
                    "the bore",
                    kind.name, rod->second, bore->second));
  }
  const auto supply = answers.find("supply-bar");
  const auto back = answers.find("return-bar");
  if (supply != answers.end() && back != answers.end() && back->second >= supply->second) {
    throw UsageError(
        fmt::format("new {}: --return-bar is {:g}; allowed: 0 to less than --supply-bar {:g}",
                    kind.name, back->second, supply->second));
  }
  check_parameters(kind, with_usual(kind, answers));
}

}  // namespace workbench::model
