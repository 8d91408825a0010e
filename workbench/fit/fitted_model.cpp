#include <cstdio>

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
    char line[200];
    std::snprintf(line, sizeof line, "# %s %.6g, 95 %% from %.6g to %.6g", p.free.name.c_str(),
                  p.value, p.low, p.high);
    const std::string more = remark(p);
    text += line + (more.empty() ? "" : "; " + more) + "\n";
  }
  return text + plant_sim::print_model(e.better);
}

}  // namespace workbench::fit
