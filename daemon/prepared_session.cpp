#include "daemon/prepared_session.h"

#include <cmath>

#include "config/schema/error.h"
#include "config/schema/hash.h"

namespace monitor {
namespace {

void check_numbers(const std::string& file, const hal::Rig& rig) {
  const auto check = [&](const char* table, std::size_t size, std::size_t most) {
    if (size <= most) return;
    throw config::schema::bad_config(file + ": [[" + table + "]]",
                                     std::to_string(size) + " of them",
                                     "at most " + std::to_string(most));
  };
  check("spare_rod", rig.spare_rods().size(), rt::kMaxSpareRods);
  check("input", rig.inputs().size(), rt::kMaxInputs);
}

void check_failover(const DaemonConfig& config) {
  if (!config.safety.failover.present || config.rig.rods() > 1) return;
  throw config::schema::bad_config(config.file + ": [failover]",
                                   "has no second rod sensor to switch to", "a [[spare_rod]]");
}

}  // namespace

PreparedSession prepare(DaemonConfig& config, std::string* absent) {
  PreparedSession p;
  p.sample_time_s = 1.0 / config.loop.rate_Hz;
  p.opening = {config.file,
               config.folder,
               p.sample_time_s,
               config.rig.valve().null_V,
               config.rig.valve().limit_V,
               absent == nullptr};
  check_numbers(config.file, config.rig);
  check_failover(config);
  try {
    p.devices = config.rig.open(p.opening);
  } catch (const config::schema::DeviceUnavailable& e) {
    if (absent == nullptr) throw;
    *absent = e.what();
  }
  p.guards = with_place(config.file,
                        [&] { return control::all_guards(config.safety, config.loop.overrun()); });
  p.never_arms = never_arms(config);
  if (!std::isnan(p.devices.sample_time_s)) p.sample_time_s = p.devices.sample_time_s;
  const bool from_file = config.reference.kind == "file";
  p.reference = with_place(config.file + ": [reference]" + (from_file ? " file" : ""), [&] {
    return control::make_reference(
        config.drives_valve() ? config.reference : control::ReferenceConfig{}, config.folder);
  });
  p.detection = make_detection_config(config, p.sample_time_s);
  p.hash = hash(config);
  return p;
}

}  // namespace monitor
