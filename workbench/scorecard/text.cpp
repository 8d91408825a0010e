// A scorecard as text: what a terminal and a README show.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/joined.h"
#include "workbench/scorecard/card.h"
#include "workbench/scorecard/words.h"

namespace workbench::scorecard {
namespace {

using TextRows = std::vector<std::vector<std::string>>;

/// Characters, not bytes.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  }));
}

std::string aligned(const TextRows& rows, const std::string& indent) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line = indent;
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += row[i] + std::string(widths[i] - width(row[i]) + 2, ' ');
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string marked(const TextRows& rows) {
  std::string out;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    out += "|";
    for (const std::string& cell : rows[r]) out += " " + cell + " |";
    out += "\n";
    if (r != 0) continue;
    out += "|";
    for (std::size_t i = 0; i < rows[r].size(); ++i) out += "---|";
    out += "\n";
  }
  return out;
}

TextRows quiet_rows(const Card& card) {
  TextRows rows{{"method", "false alarms", "per hour (95 % limit)"}};
  for (const Benign& change : card.benign) rows[0].push_back(change.id);
  rows[0].emplace_back("right");
  rows[0].emplace_back("in a group");
  rows[0].emplace_back("wrong name");
  rows[0].emplace_back("of a core");
  for (const MethodFigures& method : card.methods) {
    std::vector<std::string> row{method.name, alarms_words(method.healthy),
                                 rate_words(method.healthy)};
    for (const Benign& change : card.benign) {
      const auto at = method.benign.find(change.id);
      row.push_back(at == method.benign.end() ? "–" : benign_words(at->second));
    }
    row.push_back(share_words(method.verdict(TrialVerdict::right), method.trials()));
    row.push_back(share_words(method.verdict(TrialVerdict::group), method.trials()));
    row.push_back(share_words(method.verdict(TrialVerdict::wrong), method.trials()));
    row.push_back(
        std::isnan(method.load_ratio) ? "–" : fmt::format("{:.2g} %", 100.0 * method.load_ratio));
    rows.push_back(row);
  }
  return rows;
}

/// Faults down, methods across: smallest size in each motion.
TextRows smallest_rows(const Card& card) {
  TextRows rows{{"smallest fault detected"}};
  for (const MethodFigures& method : card.methods) rows[0].push_back(method.name);
  for (const Fault* fault : faults_of(card)) {
    std::vector<std::string> row{fault_words(*fault)};
    for (const MethodFigures& method : card.methods) {
      row.push_back(smallest_words(card, method, *fault));
    }
    rows.push_back(row);
  }
  return rows;
}

TextRows delay_rows(const Card& card) {
  TextRows rows{{"delay, median (95 %)"}};
  for (const MethodFigures& method : card.methods) rows[0].push_back(method.name);
  for (const Fault* fault : faults_of(card)) {
    std::vector<std::string> row{sized_words(*fault)};
    for (const MethodFigures& method : card.methods) row.push_back(delay_words(method, *fault));
    rows.push_back(row);
  }
  return rows;
}

std::string motions_words(const Card& card) { return config::schema::joined(card.motions, " / "); }

std::string method_text(const MethodFigures& method) {
  std::string out = "\n" + method.name + ": " + method.what + "\n";
  for (const auto& [motion, why] : method.unusable) {
    out.append("  ").append(unusable_words(motion, why)).append("\n");
  }
  TextRows rows{{"fault", "right", "group", "wrong", "no name", "missed", "alarm before",
                 "names that came first"}};
  for (const FaultFigures& of : method.faults) {
    std::vector<std::string> row{sized_words(*of.fault)};
    for (const TrialVerdict verdict :
         {TrialVerdict::right, TrialVerdict::group, TrialVerdict::wrong, TrialVerdict::unnamed,
          TrialVerdict::missed, TrialVerdict::standing}) {
      row.push_back(share_words(of.verdict(verdict), of.trials()));
    }
    row.push_back(first_words(of));
    rows.push_back(row);
  }
  return out + aligned(rows, "  ");
}

}  // namespace

std::string to_text(const Card& card, bool details) {
  std::string out;
  if (card.done < card.parts) {
    out += "Not complete: " + std::to_string(card.done) + " of " + std::to_string(card.parts) +
           " parts are done.\n\n";
  }
  out += aligned(quiet_rows(card), "");
  out += "\n" + detected_words(card) + "\nMotions: " + motions_words(card) + ".\n\n";
  out += aligned(smallest_rows(card), "") + "\n" + aligned(delay_rows(card), "");
  if (!details) return out;
  for (const MethodFigures& method : card.methods) out += method_text(method);
  return out;
}

std::string to_markdown(const Card& card) {
  return marked(quiet_rows(card)) + "\n" + detected_words(card) +
         " Motions: " + motions_words(card) + ".\n\n" + marked(smallest_rows(card)) + "\n" +
         marked(delay_rows(card));
}

}  // namespace workbench::scorecard
