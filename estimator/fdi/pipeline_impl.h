// What a Pipeline is made of. For its own files only.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/fdi/pipeline.h"
#include "estimator/fdi/stage.h"

namespace estimator::fdi {

/// One band at work.
struct Watch {
  BandState state;
  std::size_t alarm;  ///< number in the book
};

struct Reading {
  double value;
  double std_error;
  bool trusted;
  const char* why;  ///< when not trusted
  std::int64_t tick;
};

struct Worker {
  Stage stage;
  std::string settings;  ///< EstimatorConfig::fingerprint()
  std::vector<std::string> names;
  std::vector<NamedValue> values;
  std::vector<std::vector<Watch>> watches;  ///< for each value
};

struct SampleWatch {
  SampleQuantity quantity;
  Watch watch;
};

struct Pipeline::Impl {
  std::vector<std::string> ids;
  std::vector<Worker> workers;
  std::vector<SampleWatch> sample_watches;
  AlarmBook book;
  double sample_time_s = 0.0;
  bool started = false;
  std::int64_t last_tick = 0;

  Impl(const PipelineConfig& config, double sample_time);
  void add(const EstimatorConfig& config);
  void add(const BandConfig& band);
  void emit(std::size_t number, std::int64_t tick, std::int64_t utc_us, Events& events);
  void judge(Watch& watch, const Reading& reading, Events& events);
  template <class F>
  void for_each_watch(F&& f) {
    for (Worker& worker : workers) {
      for (std::vector<Watch>& watches : worker.watches) {
        for (Watch& watch : watches) f(watch);
      }
    }
    for (SampleWatch& watched : sample_watches) f(watched.watch);
  }
};

}  // namespace estimator::fdi
