// A pipeline's state on its way to a snapshot and back, or to the pipeline that follows it.
#include "estimator/fdi/pipeline_impl.h"

namespace estimator::fdi {

void Pipeline::serialize(StateArchive& archive) {
  Impl& impl = *impl_;
  archive.value(impl.started);
  archive.value(impl.last_tick);
  for (Worker& worker : impl.workers) {
    worker.source->serialize(archive);
    worker.outlet->serialize(archive);
    for (std::vector<Watch>& watches : worker.watches) {
      for (Watch& watch : watches) archive.value(watch.state);
    }
  }
  for (SampleWatch& watched : impl.sample_watches) archive.value(watched.watch.state);
  impl.book.serialize(archive);
}

std::vector<bool> Pipeline::inherit(Pipeline& before) {
  Impl& to = *impl_;
  Impl& from = *before.impl_;
  to.started = from.started;
  to.last_tick = from.last_tick;
  std::vector<bool> goes_on(to.workers.size(), false);
  std::vector<std::uint8_t> bytes;
  for (Worker& worker : to.workers) {
    Worker* const old = from.worker(worker.id);
    if (old == nullptr || old->settings != worker.settings) continue;
    bytes.clear();
    StateArchive out = StateArchive::saving(bytes);
    old->source->serialize(out);
    old->outlet->serialize(out);
    StateArchive in = StateArchive::restoring(bytes);
    worker.source->serialize(in);
    worker.outlet->serialize(in);
    goes_on[worker.number] = true;
  }
  to.for_each_watch([&](Watch& watch) {
    const Alarm& alarm = to.book.alarm(watch.alarm);
    from.for_each_watch([&](const Watch& old) {
      const Alarm& was = from.book.alarm(old.alarm);
      if (was.name == alarm.name && was.quantity == alarm.quantity) watch.state.inherit(old.state);
    });
  });
  to.book.inherit(from.book);
  return goes_on;
}

}  // namespace estimator::fdi
