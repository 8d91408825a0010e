#include "config/units/quantity.h"
#include "workbench/compare/comparison_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "workbench/present/compare_units.h"

namespace workbench::compare {

namespace units = config::units;
namespace {

constexpr std::size_t kColumns = 88;
constexpr int kBarWidth = 24;

/// Words wrapped between a margin and the line's end.
std::string wrapped(const std::string& text, const std::string& first, const std::string& next) {
  std::string out = first;
  std::size_t column = first.size();
  std::size_t from = 0;
  bool begun = false;
  while (from < text.size()) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    const std::string word = text.substr(from, to - from);
    if (begun && column + 1 + word.size() > kColumns) {
      out += "\n" + next;
      column = next.size();
      begun = false;
    }
    out += (begun ? " " : "") + word;
    column += word.size() + (begun ? 1 : 0);
    begun = true;
    from = to + 1;
  }
  return out + "\n";
}

std::string bar(double share, bool unicode) {
  const int eighths = static_cast<int>(std::lround(8.0 * kBarWidth * std::clamp(share, 0.0, 1.0)));
  std::string text;
  if (!unicode) {
    text.assign(static_cast<std::size_t>((eighths + 4) / 8), '#');
    return text;
  }
  static constexpr const char* kParts[] = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  for (int i = 0; i < eighths / 8; ++i) text += "█";
  return text + kParts[eighths % 8];
}

std::string numbers(const validation::Comparison& c, const DisturbanceCheck& check) {
  std::string out;
  const auto row = [&](const std::string& name, const std::string& value,
                       const std::string& beside) {
    out += fmt::format("  {:22} {:>10}   {}", name, value, beside);
    out.erase(out.find_last_not_of(' ') + 1);
    out += "\n";
  };
  const auto times_floor = [&](double rms_m) {
    if (!std::isfinite(c.noise_floor_m) || !std::isfinite(rms_m)) return std::string();
    return units::three_digits(rms_m / c.noise_floor_m) + " x the noise floor";
  };
  row("drift-corrected", units::length_words(c.rms_m), times_floor(c.rms_m));
  row("free run", units::length_words(c.free_run_rms_m),
      "fit " + units::three_digits(c.fit_percent) + " %");
  for (const validation::KStep& k : c.k_step) {
    const double ahead_s = static_cast<double>(k.samples) * c.record.sample_time_s;
    row(fmt::format("{}-step prediction", k.samples), units::length_words(k.rms_m),
        k.count == 0 ? "no stretch is long enough"
                     : "over " + units::three_digits(1e3 * ahead_s) + " ms");
  }
  if (check.found) {
    row("sensor, disturbance", units::length_words(check.found->floor_m),
        times_floor(check.found->floor_m));
  }
  row("noise floor", units::length_words(c.noise_floor_m),
      c.encoder_step_m > 0.0 ? "encoder step " + units::length_words(c.encoder_step_m) : "");
  row("white", "p " + units::chance_words(c.whiteness_p), "");
  row("independent of command", "p " + units::chance_words(c.independence_p), "");
  return out;
}

std::string chart(const validation::Region& region, bool unicode) {
  const present::DisplayUnit unit = present::unit_of(region.variable);
  double most = 0.0;
  for (const validation::Bin& bin : region.bins)
    most = std::max(most, bin.local_velocity_error_rms_mps);
  const std::string head =
      unit.text.empty() ? std::string(unit.name) : std::string(unit.name) + ", " + unit.text;
  std::string out = fmt::format("  {:20} {:>9} {:>10} {:>6} {:>6}\n", head, "error RMS",
                                "speed err.", "time", "share");
  for (const validation::Bin& bin : region.bins) {
    out += fmt::format("  {:20} {:>9} {:>10} {:5.0f}% {:5.0f}% ",
                       present::bin_text(region.variable, bin), units::length_words(bin.rms_m),
                       units::speed_words(bin.local_velocity_error_rms_mps), 100.0 * bin.time_share,
                       100.0 * bin.local_velocity_error_share) +
           bar(most > 0.0 ? bin.local_velocity_error_rms_mps / most : 0.0, unicode) + "\n";
  }
  return out;
}

const validation::Region* find(const validation::Comparison& c, const std::string& variable) {
  for (const validation::Region& region : c.regions) {
    if (region.variable == variable) return &region;
  }
  return nullptr;
}

/// Regions that the chart shows: all, or the most significant variable, and the direction.
std::vector<const validation::Region*> shown(const validation::Comparison& c, bool all) {
  std::vector<const validation::Region*> regions;
  if (all) {
    for (const validation::Region& region : c.regions) regions.push_back(&region);
    return regions;
  }
  for (const validation::SignificantRegion& failing : c.worst) {
    if (failing.ranges.front().variable == "direction") continue;
    regions.push_back(find(c, failing.ranges.front().variable));
    break;
  }
  if (const validation::Region* direction = find(c, "direction")) regions.push_back(direction);
  return regions;
}

}  // namespace

std::string to_text(const validation::Comparison& c, bool unicode, bool all,
                    const DisturbanceCheck& check) {
  const Words said = words(c, check);
  std::string out = fmt::format("{} against {}: {} s, {} samples at {} Hz", c.model, c.record.name,
                                units::three_digits(c.duration_s()), c.record.size(),
                                units::three_digits(1.0 / c.record.sample_time_s));
  if (c.record.starts.size() > 1) out += fmt::format(", {} segments", c.record.starts.size());
  out += "\n";
  for (const std::string& note : notes(c)) out += wrapped("note: " + note, "  ", "        ");
  out += "\n" + wrapped(said.verdict, "  ", "  ");
  for (const std::string& sentence : said.lines) out += wrapped(sentence, "  - ", "    ");
  out += "\n" + numbers(c, check);
  if (said.judgement == Judgement::useless) return out;
  const bool noise = said.judgement == Judgement::at_floor;
  for (const validation::Region* region : shown(c, all)) {
    if (noise && !all) break;
    out += "\n" + chart(*region, unicode);
  }
  return out;
}

}  // namespace workbench::compare
