// A scorecard as a page with plots.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/joined.h"
#include "config/signals/nan.h"
#include "workbench/scorecard/card.h"
#include "workbench/scorecard/words.h"

namespace workbench::scorecard {
namespace {

using present::Plot;
using present::Table;

using config::signals::kNaN;

std::vector<std::string> method_names(const Card& card) {
  std::vector<std::string> names;
  for (const MethodFigures& method : card.methods) names.push_back(method.name);
  return names;
}

present::Section false_alarms(const Card& card) {
  present::Section section;
  section.heading = "False alarms";
  section.paragraphs = {
      "An alarm counts once, when it comes while none stands. The limit is that of Poisson's law: "
      "a higher rate would have given more alarms in those hours with 95 %."};
  Table table;
  table.columns = {
      {"method", "", false}, {"healthy", "h"}, {"alarms"}, {"rate", "1/h"}, {"limit", "1/h"}};
  for (const Benign& change : card.benign) table.columns.push_back({change.id, "", false});
  Plot plot;
  plot.title = "False alarms when healthy";
  plot.kind = present::PlotKind::bars;
  plot.horizontal = true;
  plot.categories = method_names(card);
  plot.y = {"upper limit (95 %)", "1/h", true};
  present::Series limit{"limit", {}, {}, present::Tone::residual, {}, false};
  for (const MethodFigures& method : card.methods) {
    const QuietFigures& q = method.healthy;
    const bool any = q.hours > 0.0;
    std::vector<std::string> row{method.name, fmt::format("{:.3g}", q.hours),
                                 std::to_string(q.counted.alarms),
                                 any ? fmt::format("{:.2g}", q.per_hour()) : "",
                                 any ? fmt::format("{:.2g}", q.per_hour_upper()) : ""};
    for (const Benign& change : card.benign) {
      const auto at = method.benign.find(change.id);
      row.push_back(at == method.benign.end() ? "" : benign_words(at->second));
    }
    table.rows.push_back(row);
    limit.y.push_back(any ? q.per_hour_upper() : kNaN);
  }
  plot.series = {limit};
  plot.lines = {{1.0 / 24.0, "one in 24 h"}};
  section.plots = {plot};
  section.tables = {table};
  for (const Benign& change : card.benign) {
    section.paragraphs.push_back("No fault, \"" + change.id + "\": " + change.what + ".");
  }
  return section;
}

Plot smallest_plot(const Card& card, const Fault& fault) {
  Plot plot;
  plot.title = fault_words(fault);
  plot.kind = present::PlotKind::bars;
  plot.horizontal = true;
  plot.width = present::PlotWidth::half;
  plot.categories = method_names(card);
  plot.y = {"smallest detected, " + card.motions.front(), fault.unit, true};
  present::Series bars{"smallest", {}, {}, present::Tone::model, {}, false};
  for (const MethodFigures& method : card.methods) {
    const FaultFigures* const of = figures_of(method, fault);
    const auto smallest = of == nullptr ? std::nullopt : of->smallest(card.motions.front());
    bars.y.push_back(smallest && !smallest->beyond ? smallest->size : kNaN);
  }
  plot.series = {bars};
  return plot;
}

present::Section smallest(const Card& card) {
  present::Section section;
  section.heading = "Smallest fault detected";
  section.paragraphs = {detected_words(card)};
  Table table;
  table.columns = {{"fault", "", false}};
  for (const MethodFigures& method : card.methods)
    table.columns.push_back({method.name, "", false});
  for (const Fault* fault : faults_of(card)) {
    if (!(fault->least > 0.0)) continue;
    std::vector<std::string> row{fault_words(*fault)};
    for (const MethodFigures& method : card.methods) {
      row.push_back(smallest_words(card, method, *fault));
    }
    table.rows.push_back(row);
    Plot plot = smallest_plot(card, *fault);
    const auto& y = plot.series[0].y;
    const auto missing = std::count_if(y.begin(), y.end(), [](double v) { return std::isnan(v); });
    if (missing == static_cast<std::ptrdiff_t>(y.size())) continue;
    if (missing > 0) plot.caption = "No bar: not even the greatest size is detected.";
    section.plots.push_back(std::move(plot));
  }
  table.caption = "Motions: " + config::schema::joined(card.motions, " / ");
  section.tables = {table};
  return section;
}

/// Share of the trials that a method had detected so long after the fault.
Plot delay_plot(const Card& card, const Fault& fault) {
  Plot plot;
  plot.title = sized_words(fault);
  plot.kind = present::PlotKind::steps;
  plot.width = present::PlotWidth::half;
  plot.x = {"after the fault", "s"};
  plot.y = {"detected", "%"};
  plot.lines = {{100.0 * kDetected, "asked for"}};
  for (const MethodFigures& method : card.methods) {
    const FaultFigures* const of = figures_of(method, fault);
    if (of == nullptr || of->trials() == 0) continue;
    std::vector<double> delays_s = of->delays_s();
    std::sort(delays_s.begin(), delays_s.end());
    present::Series curve{method.name, {0.0}, {0.0}, present::Tone::automatic, {}, false};
    double share = 0.0;
    for (std::size_t i = 0; i < delays_s.size() && std::isfinite(delays_s[i]); ++i) {
      share = 100.0 * static_cast<double>(i + 1) / static_cast<double>(delays_s.size());
      curve.x.push_back(delays_s[i]);
      curve.y.push_back(share);
    }
    curve.x.push_back(card.watch_s);
    curve.y.push_back(share);
    curve.dashed = plot.series.size() >= 6;  // colours repeat
    plot.series.push_back(std::move(curve));
  }
  return plot;
}

present::Section delays(const Card& card) {
  present::Section section;
  section.heading = "Delay";
  section.paragraphs = {"At the stated size, over all motions and both directions."};
  Table table;
  table.caption = "Median (95 %)";
  table.columns = {{"fault", "", false}, {"size", "", false}};
  for (const MethodFigures& method : card.methods)
    table.columns.push_back({method.name, "", false});
  for (const Fault* fault : faults_of(card)) {
    std::vector<std::string> row{fault_words(*fault), stated_words(*fault)};
    for (const MethodFigures& method : card.methods) row.push_back(delay_words(method, *fault));
    table.rows.push_back(row);
    Plot plot = delay_plot(card, *fault);
    if (!plot.series.empty()) section.plots.push_back(std::move(plot));
  }
  section.tables = {table};
  return section;
}

Table matrix(const MethodFigures& method) {
  std::map<std::string, int> columns;
  for (const FaultFigures& of : method.faults) {
    for (const auto& [names, count] : of.first) columns[names] += count;
  }
  Table table;
  table.caption = method.name + ": " + method.what;
  table.columns = {{"true fault", "", false}};
  for (const auto& [names, count] : columns) table.columns.push_back({names_words(names), "%"});
  table.columns.push_back({"missed", "%"});
  table.columns.push_back({"alarm before", "%"});
  for (const FaultFigures& of : method.faults) {
    const auto percent = [&](int count) {
      return count == 0 ? "" : fmt::format("{:.0f}", 100.0 * count / of.trials());
    };
    std::vector<std::string> row{sized_words(*of.fault)};
    for (const auto& [names, count] : columns) {
      const auto at = of.first.find(names);
      row.push_back(at == of.first.end() ? "" : percent(at->second));
    }
    row.push_back(percent(of.verdict(TrialVerdict::missed)));
    row.push_back(percent(of.verdict(TrialVerdict::standing)));
    table.rows.push_back(row);
  }
  return table;
}

present::Section names(const Card& card) {
  present::Section section;
  section.heading = "Names";
  section.paragraphs = {
      "The true fault and what the first alarm named, at the stated size, over all motions, "
      "directions and seeds. \"a or b\": the alarm says that they cannot be told apart."};
  Table judged;
  judged.caption =
      "Every alarm of a trial judged: right, all name the fault alone; group, all "
      "name a group that holds it; wrong, one does not";
  judged.columns = {{"method", "", false}, {"right", "%"},  {"group", "%"},       {"wrong", "%"},
                    {"no name", "%"},      {"missed", "%"}, {"alarm before", "%"}};
  for (const MethodFigures& method : card.methods) {
    std::vector<std::string> row{method.name};
    for (const TrialVerdict verdict :
         {TrialVerdict::right, TrialVerdict::group, TrialVerdict::wrong, TrialVerdict::unnamed,
          TrialVerdict::missed, TrialVerdict::standing}) {
      row.push_back(method.trials() == 0
                        ? ""
                        : fmt::format("{:.1f}", 100.0 * method.verdict(verdict) / method.trials()));
    }
    judged.rows.push_back(row);
  }
  section.tables.push_back(judged);
  for (const MethodFigures& method : card.methods) {
    if (!method.faults.empty()) section.tables.push_back(matrix(method));
  }
  return section;
}

}  // namespace

present::Report to_report(const Card& card) {
  present::Report page;
  page.title = "Scorecard";
  const bool complete = card.done == card.parts;
  page.state = complete ? present::ReportState::good : present::ReportState::warn;
  page.verdict = std::to_string(card.methods.size()) + " methods, " +
                 std::to_string(faults_of(card).size()) + " faults, " +
                 std::to_string(card.motions.size()) +
                 (card.motions.size() == 1 ? " motion" : " motions");
  if (!complete) {
    page.summary.push_back("Not complete: " + std::to_string(card.done) + " of " +
                           std::to_string(card.parts) + " parts are done.");
  }
  for (const MethodFigures& method : card.methods) {
    for (const auto& [motion, why] : method.unusable) {
      page.summary.push_back(method.name + " " + unusable_words(motion, why));
    }
  }
  double healthy_h = 0.0;
  for (const MethodFigures& method : card.methods) {
    healthy_h = std::max(healthy_h, method.healthy.hours);
  }
  page.facts = {{"trials of a fault", std::to_string(card.seeds), "each"},
                {"healthy", fmt::format("{:.3g}", healthy_h), "h"},
                {"time to detect", fmt::format("{:.3g}", card.watch_s), "s"},
                {"computed in", fmt::format("{:.0f}", card.runtime_s), "s"}};
  page.command = card.command;
  page.sections = {false_alarms(card)};
  if (!faults_of(card).empty()) {
    page.sections.push_back(smallest(card));
    page.sections.push_back(delays(card));
    page.sections.push_back(names(card));
  }
  return page;
}

}  // namespace workbench::scorecard
