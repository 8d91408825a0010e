// An exact integrator as a rig, and a pipeline that watches its gain.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "estimator/fdi/pipeline.h"
#include "tests/estimator/fdi/recorder.h"

namespace fdi_test {

using config::signals::Sample;
using estimator::fdi::BandConfig;
using estimator::fdi::EstimatorConfig;
using estimator::fdi::Pipeline;
using estimator::fdi::PipelineConfig;

inline constexpr double kSampleTime_s = 0.005;
inline constexpr double kGain_m_per_V = 2e-4;

/// y(t) = y(t-1) + gain u(t-1), u a sine of 2 V at 1 Hz: ARX111 with a1 = -1, b1 = gain exactly.
class Integrator {
 public:
  double gain_m_per_V = kGain_m_per_V;
  double amplitude_V = 2.0;

  Sample next() {
    Sample s;
    s.tick = tick_;
    s.y_m = y_m_;
    s.u_applied_V = amplitude_V * std::sin(2.0 * M_PI * kSampleTime_s * static_cast<double>(tick_));
    y_m_ += gain_m_per_V * s.u_applied_V;
    ++tick_;
    return s;
  }

 private:
  double y_m_ = 0.0;
  std::int64_t tick_ = 0;
};

/// One estimator of 1 s windows and a band on its b1.
inline PipelineConfig watched(const std::string& method) {
  PipelineConfig config;
  EstimatorConfig estimator;
  estimator.id = "e";
  estimator.method = method;
  estimator.window_s = 1.0;
  estimator.stride_s = 0.1;
  config.estimators.push_back(estimator);
  BandConfig band;
  band.id = "gain";
  band.quantity = "e.b1";
  band.low = 1.9e-4;
  band.high = 2.1e-4;
  band.parameter = "valve_gain_m_per_V";
  config.bands.push_back(band);
  return config;
}

inline void run(Pipeline& pipeline, Integrator& plant, int samples, Recorder& seen) {
  for (int i = 0; i < samples; ++i) pipeline.process(plant.next(), seen);
}

}  // namespace fdi_test
