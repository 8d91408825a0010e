#include "workbench/diagnose/doubt_words.h"

#include <algorithm>
#include <utility>

#include "config/schema/joined.h"
#include "workbench/diagnose/effect_words.h"

namespace workbench::diagnose {
namespace {

std::string reason_words(selection::Doubt doubt, bool several) {
  switch (doubt) {
    case selection::Doubt::at_bound:
      return several ? "the size of each is at the bound of what it can be"
                     : "its size is at the bound of what it can be";
    case selection::Doubt::within_error:
      return several ? "the size of each is within its error" : "its size is within its error";
    case selection::Doubt::chance:
      return std::string("what ") + (several ? "each" : "it") +
             " gains is so little, or so uneven over the record, that it may be chance";
    case selection::Doubt::undriven:
      return std::string("the rig's response to disturbances speaks for ") +
             (several ? "them, their" : "it, its") +
             " commanded motion hardly does; a disturbance with another spectrum would look the "
             "same";
    case selection::Doubt::strained:
      return std::string("several of the plant's parameters end at their bounds beside ") +
             (several ? "them: they" : "it: it") + " may stand in for another law";
    case selection::Doubt::below_noise:
      return std::string("noise explains the model without ") + (several ? "them" : "it") +
             ", and what " + (several ? "each" : "it") +
             " removes is small beside it: the plant's laws may be off by as much";
    case selection::Doubt::rivals:
      return "others do as well";
    case selection::Doubt::remainder:
      return std::string("what remains unexplained is no smaller than what ") +
             (several ? "each" : "it") + " explains";
    case selection::Doubt::interrupted:
      return "not everything was tried";
    case selection::Doubt::stand_in:
      break;
  }
  return several ? "they may stand in for another law: what remains enters as they do, or several "
                   "share it"
                 : "may stand in for another law: what remains enters as it does, or several share "
                   "it";
}

/// "backlash (its size is within its error); null_bias and friction (others do as well)".
std::string possible_words(const selection::Diagnosis& d) {
  std::vector<std::pair<selection::Doubt, std::vector<std::string>>> doubts;
  for (const selection::PossibleEffect& one : d.possible) {
    auto same = std::find_if(doubts.begin(), doubts.end(),
                             [&](const auto& doubt) { return doubt.first == one.why; });
    if (same == doubts.end()) same = doubts.insert(doubts.end(), {one.why, {}});
    same->second.push_back(name_words(d, one.effect));
  }
  const auto text = [](const auto& doubt) {
    return config::schema::listed(doubt.second) + " (" +
           reason_words(doubt.first, doubt.second.size() > 1) + ")";
  };
  return config::schema::joined_by(doubts, text, "; ");
}

/// Parameters at their bounds in a model that noise explains without the effect that may be
/// missing.
std::string otherwise_words(const selection::Diagnosis& d) {
  if (d.search.path.empty() || d.possible.size() != 1) return "";
  if (d.possible.front().why != selection::Doubt::below_noise) return "";
  const estimator::greybox::FitSummary& without = d.search.path.front().fitted;
  std::vector<std::string> at_bound;
  for (std::size_t i = 0; i < without.at_bound.size(); ++i) {
    if (without.at_bound[i] != 0) at_bound.push_back(without.parameters[i].name);
  }
  if (at_bound.empty()) return "";
  const std::string effect = name_words(d, d.possible.front().effect);
  return "Without " + effect + ", " + config::schema::listed(at_bound) +
         (at_bound.size() == 1 ? " ends at its bound" : " end at their bounds") + ": either " +
         effect + " is missing, or the file is wrong about " +
         (at_bound.size() == 1 ? at_bound.front() : "these values") + ".";
}

}  // namespace

std::vector<std::string> doubt_words(const selection::Diagnosis& d) {
  std::vector<std::string> out{"Not established: " + possible_words(d) + "."};
  if (std::string text = otherwise_words(d); !text.empty()) out.push_back(std::move(text));
  return out;
}

}  // namespace workbench::diagnose
