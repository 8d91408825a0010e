// Keeps what a pipeline reports, for tests to look at.
#pragma once

#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"

namespace fdi_test {

struct SeenEstimate {
  std::size_t estimator;
  std::int64_t tick;
  bool valid;
  bool warming_up;
  std::string reason;
  double b1;
};

class Recorder final : public estimator::fdi::Events {
 public:
  void on_estimate(const estimator::fdi::EstimateEvent& e) override {
    estimates.push_back(
        {e.estimator, e.tick, e.valid, e.warming_up, std::string(e.reason), e.value("b1")});
  }
  void on_alarm(const estimator::fdi::Alarm& alarm) override { alarms.push_back(alarm); }

  std::vector<SeenEstimate> estimates;
  std::vector<estimator::fdi::Alarm> alarms;
};

}  // namespace fdi_test
