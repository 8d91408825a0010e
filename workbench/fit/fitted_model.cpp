#include <fmt/format.h>

#include "config/units/quantity.h"
#include "workbench/fit/outcome.h"

namespace workbench::fit {

std::string to_model(const Outcome& o) {
  const greybox::Estimation& e = o.estimation;
  std::string text = "# Fitted by: " + o.prepared->command + "\n";
  for (const auto& record : o.prepared->task.evidence.records)
    text += "# record " + record.name + "\n";
  text += "# error " + config::units::length_words(e.before.rms_m) + " -> " +
          config::units::length_words(e.after.rms_m) + " RMS" +
          (e.interrupted ? "; interrupted, the best so far" : "") + "\n";
  for (const greybox::Parameter& p : e.parameters) {
    const std::string more = remark(p);
    text += fmt::format("# {} {:.6g}, 95 % from {:.6g} to {:.6g}{}{}\n", p.search.name, p.value,
                        p.low, p.high, more.empty() ? "" : "; ", more);
  }
  return text + plant_sim::print_model(e.better);
}

}  // namespace workbench::fit
