#include <fmt/format.h>

#include "config/units/quantity.h"
#include "workbench/fit/fit_report.h"

namespace workbench::fit {

std::string to_model(const FitReport& o) {
  const greybox::EstimationSummary& e = o.estimation;
  std::string text = "# Fitted by: " + o.prepared->command + "\n";
  for (const auto& record : o.prepared->problem.data.records)
    text += "# record " + record.name + "\n";
  text += "# error " + config::units::length_words(e.before.rms_m) + " -> " +
          config::units::length_words(e.after.rms_m) + " RMS" +
          (e.interrupted ? "; interrupted, the best so far" : "") + "\n";
  for (const greybox::EstimatedParameter& p : e.parameters) {
    const std::string more = remark(p);
    text += fmt::format("# {} {:.6g}, 95 % from {:.6g} to {:.6g}{}{}\n", p.free.name, p.value,
                        p.low, p.high, more.empty() ? "" : "; ", more);
  }
  return text + plant_sim::print_model(e.better);
}

}  // namespace workbench::fit
