#include "daemon/configuration_reference.h"

#include "config/schema/reference.h"
#include "daemon/control/calibration.h"
#include "daemon/daemon_config.h"

namespace monitor {
namespace {

std::vector<std::string> backends() {
  std::vector<std::string> found;
  const std::string names = hal::backend_names() + ", ";
  std::size_t at = 0;
  for (std::size_t end = 0; (end = names.find(", ", at)) != std::string::npos; at = end + 2) {
    found.push_back(names.substr(at, end - at));
  }
  return found;
}

}  // namespace

std::string configuration_reference() {
  using config::schema::Visitor;
  std::vector<std::string> or_none = backends();
  or_none.emplace_back("none");
  return "\n## Daemon\n\nRead by `spoolwatchd --config FILE`.\n" +
         config::schema::print_reference([](Visitor& v) { DaemonConfig().visit(v); }, 3,
                                         {{"valve.backend", or_none}, {"backend", backends()}}) +
         "\n## Calibration file\n\nWritten by `spoolwatch commission`, named by `[rig] "
         "calibration`.\n" +
         config::schema::print_reference([](Visitor& v) { control::Calibration().visit(v); });
}

}  // namespace monitor
