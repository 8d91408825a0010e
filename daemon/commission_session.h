// One commissioning on open devices: runs the stages in order, asks the operator, reports and
// writes the calibration file.
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
  /// Thrown when the operator stops or the procedure aborts; already reported.
  struct Ended {
    int exit_code;
  };

  void stages();
  void agree(const std::string& question);
  void stage(const char* name, const std::function<void()>& begin);
  void sign();
  void speeds();
  /// Drives to the stop or index and returns the reading there.
  double home(int direction, bool index);
  void homes();
  [[noreturn]] void abort(const std::string& why);
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
