// What a Pipeline is made of. For its own files only.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "estimator/fdi/pipeline.h"

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
  std::size_t number;  ///< in PipelineConfig::source_ids()
  std::string id;
  std::unique_ptr<Source> source;
  std::unique_ptr<Outlet> outlet;
  std::string settings;                     ///< fingerprint, and those of the sources that it reads
  std::vector<std::string> names;           ///< of its values
  std::vector<std::vector<Watch>> watches;  ///< for each value
  std::vector<std::size_t> own_alarms;      ///< their numbers in the book
};

struct SampleWatch {
  std::size_t quantity;  ///< number in kSampleQuantities
  Watch watch;
};

struct Pipeline::Impl final : private Inputs {
  std::vector<Worker> workers;  ///< in the order of their work: each after those that it reads
  Outlet sample;                ///< the present sample's own quantities
  std::vector<SampleWatch> sample_watches;
  AlarmBook book;
  double sample_time_s = 0.0;
  bool started = false;
  std::int64_t last_tick = 0;

  Impl(const PipelineConfig& config, double sample_time);
  void add_sources(const PipelineConfig& config);
  void add(std::size_t number, const std::string& id, std::unique_ptr<Source> source,
           std::string settings);
  void add(const BandConfig& band);
  void take(const config::signals::Sample& taken);
  void emit(Worker& worker, std::int64_t tick, std::int64_t utc_us, Events& events);
  void judge(Watch& watch, const Reading& reading, Events& events);
  [[nodiscard]] Worker* worker(std::string_view id) noexcept;
  /// Numbers of a source (workers.size() for the sample) and of its value. Throws schema::Error at
  /// `where` when there is no such value.
  [[nodiscard]] std::pair<std::size_t, std::size_t> place(const std::string& quantity,
                                                          const std::string& where) const;
  [[nodiscard]] Input find(const std::string& quantity, const std::string& where) const override;
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
