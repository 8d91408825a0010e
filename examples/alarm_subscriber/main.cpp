// Prints every change of an alarm: alarm_subscriber [LCM_URL].
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <string>

#include "spoolwatch/alarm_t.hpp"

namespace {

class AlarmPrinter {
 public:
  void on_alarm(const lcm::ReceiveBuffer* /*buffer*/, const std::string& /*channel*/,
                const spoolwatch::alarm_t* alarm) {
    if (alarm->run_id != run_id_) known_.clear();  // the daemon was started again
    run_id_ = alarm->run_id;
    const std::string name = alarm->source + "." + alarm->name;
    const int severity = alarm->active != 0 ? alarm->severity : 0;
    const auto found = known_.find(name);
    const int before = found == known_.end() ? 0 : found->second;
    known_[name] = severity;
    if (severity == before) return;  // an active alarm is repeated every second
    static const char* const kSeverity[] = {"OK", "MINOR", "MAJOR", "INVALID"};
    std::printf("%-8s %s: %s = %g, %s\n", kSeverity[severity & 3], name.c_str(),
                alarm->quantity.c_str(), alarm->value, alarm->reason.c_str());
    std::fflush(stdout);
  }

 private:
  std::int64_t run_id_ = 0;
  std::map<std::string, int> known_;  ///< severity of each alarm, 0 while it is not active
};

}  // namespace

int main(int argc, char** argv) {
  lcm::LCM lcm(argc > 1 ? argv[1] : "udpm://239.255.76.67:7667?ttl=0");
  if (!lcm.good()) {
    std::fprintf(stderr, "alarm_subscriber: LCM cannot be opened\n");
    return 1;
  }
  AlarmPrinter printer;
  lcm.subscribe("SPOOLWATCH_ALARM", &AlarmPrinter::on_alarm, &printer);
  while (lcm.handle() == 0) {
  }
  return 0;  // the end of a log
}
