// A fit for the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/joined.h"
#include "config/units/quantity.h"
#include "estimator/nonlinear/profile.h"
#include "workbench/fit/fit_report.h"

namespace workbench::fit {
namespace {

constexpr std::size_t kColumns = 92;
constexpr int kPlotWidth = 61;
constexpr int kPlotHeight = 6;

std::string wrapped(const std::string& text, const std::string& indent) {
  std::string out;
  std::size_t column = 0;
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    if (column > 0 && column + 1 + word.size() > kColumns) {
      out += "\n" + indent;
      column = indent.size();
    } else if (column > 0) {
      out += " ";
      ++column;
    }
    out += word;
    column += word.size();
    from = to + 1;
  }
  return out + "\n";
}

std::string five(double value) { return std::isnan(value) ? "-" : fmt::format("{:.5g}", value); }

std::string table(const std::vector<greybox::EstimatedParameter>& parameters) {
  std::size_t width = 9;
  for (const greybox::EstimatedParameter& p : parameters)
    width = std::max(width, p.free.name.size());
  const auto row = [&](const std::string& name, const std::string& start, const std::string& value,
                       const std::string& error, const std::string& low, const std::string& high,
                       const std::string& what) {
    std::string line = fmt::format("  {:{}} {:>11} {:>11} {:>10} {:>11} {:>11}  {}", name, width,
                                   start, value, error, low, high, what);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
  };
  std::string out = row("parameter", "start", "fitted", "+-", "95 % from", "to", "");
  for (const greybox::EstimatedParameter& p : parameters) {
    const bool shows = p.at_bound == 0 || p.from_profile;
    out += row(p.free.name, five(p.start), five(p.value), fmt::format("{:.2g}", p.std_error),
               shows ? five(p.low) : "-", shows ? five(p.high) : "-", remark(p));
  }
  return out;
}

/// The rise of the cost over the parameter's value, up to twice the threshold.
std::string plot(const greybox::EstimatedParameter& p) {
  const auto& points = p.profile;
  const double least = points.front().value;
  const double most = points.back().value;
  std::string out = "Profile of " + p.free.name + ": 95 % from " + five(p.low) +
                    (p.low_found ? "" : " (its bound)") + " to " + five(p.high) +
                    (p.high_found ? "" : " (its bound)") +
                    (p.doubt == greybox::IntervalDoubt::none ? "" : "; " + to_string(p.doubt)) +
                    "\n";
  if (!(most > least)) return out;
  std::vector<std::string> rows(kPlotHeight + 1, std::string(kPlotWidth, ' '));
  rows[kPlotHeight / 2].assign(kPlotWidth, '.');
  std::size_t k = 1;
  for (int c = 0; c < kPlotWidth; ++c) {
    const double x = least + (most - least) * c / (kPlotWidth - 1);
    while (k + 1 < points.size() && points[k].value < x) ++k;
    const auto& a = points[k - 1];
    const auto& b = points[k];
    const double part = b.value > a.value ? (x - a.value) / (b.value - a.value) : 0.0;
    // Roots of the rise are nearly straight.
    const auto root = [](double rise) { return std::copysign(std::sqrt(std::abs(rise)), rise); };
    const double sign_a = a.value < p.value ? -1.0 : 1.0;
    const double sign_b = b.value <= p.value ? -1.0 : 1.0;
    const double z = sign_a * root(a.rise) * (1.0 - part) + sign_b * root(b.rise) * part;
    const double height = z * z / (2.0 * estimator::nonlinear::kProfile95) * kPlotHeight;
    if (height > kPlotHeight + 0.5) continue;
    rows[static_cast<std::size_t>(kPlotHeight - std::lround(height))][static_cast<std::size_t>(c)] =
        '*';
  }
  for (int r = 0; r <= kPlotHeight; ++r) {
    const char* const label = r == 0 ? "  7.7" : r == kPlotHeight / 2 ? "  3.8" : "     ";
    out += std::string(r == kPlotHeight ? "    0" : label) + " |" +
           rows[static_cast<std::size_t>(r)] + "\n";
  }
  const std::string left = five(least);
  const std::string right = five(most);
  const std::size_t used = left.size() + right.size();
  out += "       " + left + std::string(used < kPlotWidth ? kPlotWidth - used : 1, ' ') + right +
         " " + config::units::axis_unit(config::units::unit_of(p.free.name)) + "\n";
  return out;
}

}  // namespace

std::string to_text(const FitReport& o) {
  const PreparedFit& prepared = *o.prepared;
  std::string out = prepared.problem.model.name + " fitted to " +
                    config::schema::joined(record_names(o)) + "\n\n";
  for (const std::string& line : words(o)) out += wrapped(line, "  ");
  out += "\n" + table(o.estimation.parameters);
  for (const greybox::EstimatedParameter& p : o.estimation.parameters) {
    if (p.profile.size() > 2) out += "\n" + plot(p);
  }
  if (!o.output.empty()) out += "\n" + o.output + " holds the fitted model.\n";
  return out;
}

}  // namespace workbench::fit
