#include "tests/soak/quiet.h"

#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "config/messages/decode.h"
#include "tests/daemon/program/log.h"
#include "tests/daemon/program/subprocess.h"
#include "tests/soak/event_pipe.h"
#include "tests/soak/process.h"

namespace soak {
namespace {

namespace fs = std::filesystem;

constexpr double kRate_Hz = 200.0;

template <class Message>
Message read(const EventPipe& events) {
  Message message;
  const auto size = static_cast<int>(events.data().size());
  if (!config::messages::decode(message, events.data().data(), size)) {
    throw std::runtime_error("a message is damaged");
  }
  return message;
}

void take(const EventPipe& events, QuietResult& result) {
  const std::string& channel = events.channel();
  if (channel.ends_with("_SAMPLE")) ++result.samples;
  if (channel.ends_with("_ESTIMATE")) {
    ++result.estimates;
    if (read<spoolwatch::estimate_t>(events).valid != 0) ++result.valid;
  }
  if (channel.ends_with("_ALARM")) {
    const auto alarm = read<spoolwatch::alarm_t>(events);
    if (alarm.active == 0 || alarm.repeat != 0) return;
    result.alarms.push_back(
        std::to_string(std::lround(static_cast<double>(alarm.tick) / kRate_Hz)) + " s " +
        alarm.source + "." + alarm.name);
  }
}

}  // namespace

QuietResult run_quiet(const QuietOptions& options) {
  const program::Folder folder;
  const fs::path file = folder.path() / "quiet.toml";
  const fs::path pipe = folder.path() / "messages";
  const fs::path model =
      fs::absolute(options.config).parent_path() / "models" / "thesis_calibrated.toml";
  std::ofstream(file) << configuration(options.config, options.faults);
  if (mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("cannot make a pipe");
  program::Daemon daemon(
      {"--config", file.string(), "--clock", "virtual", "--duration",
       std::to_string(std::lround(options.hours * 3600.0)), "--lcm-url",
       "file://" + pipe.string() + "?mode=w", "--set", "sim.model=" + model.string(), "--set",
       "tracker.0.model=" + model.string(), "--set", "sim.seed=" + std::to_string(options.seed)});
  EventPipe events(pipe, [&] { return runs(daemon.pid()); });
  QuietResult result;
  while (events.next()) take(events, result);
  const program::Result ended = daemon.wait();
  result.exit_code = ended.exit_code;
  result.err = ended.err;
  return result;
}

}  // namespace soak
