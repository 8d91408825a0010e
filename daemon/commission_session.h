// One commissioning on open devices: the stages in their order, what a person is asked, what is
// said, and the file at the end.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "daemon/commission.h"
#include "daemon/commission_loop.h"
#include "daemon/control/calibration.h"
#include "daemon/operator_prompt.h"

namespace monitor {

class CommissionSession {
 public:
  CommissionSession(DaemonConfig& config, const CommissionOptions& options,
                    const control::CommissioningLimits& limits, OperatorPrompt& prompt,
                    std::ostream& out)
      : config_(config),
        options_(options),
        limits_(limits),
        out_(out),
        procedure_(limits),
        prompt_(prompt) {}

  /// Returns the exit code; throws config::schema::Error.
  int run(const hal::Devices& devices, double sample_time_s);

 private:
  /// Stopped or refused by a person, or given up; said already.
  struct Ended {
    int exit_code;
  };

  void stages();
  void agree(const std::string& question);
  void stage(const char* name, const std::function<void()>& begin);
  void sign();
  void speeds();
  /// The reading at the stop or index.
  double home(int direction, bool index);
  void homes();
  [[noreturn]] void give_up(const std::string& why);
  void write(std::int64_t utc_us);

  DaemonConfig& config_;
  const CommissionOptions& options_;
  control::CommissioningLimits limits_;
  std::ostream& out_;
  control::Commissioning procedure_;
  control::Calibration found_;
  OperatorPrompt& prompt_;
  CommissionLoop* loop_ = nullptr;
};

}  // namespace monitor
