// A pipeline's state on its way to a snapshot and back, or to the pipeline that follows it.
#include <algorithm>

#include "estimator/fdi/pipeline_impl.h"

namespace estimator::fdi {

void Pipeline::carry(Carrier& carrier) {
  Impl& impl = *impl_;
  carrier.value(impl.started);
  carrier.value(impl.last_tick);
  for (Worker& worker : impl.workers) {
    worker.stage.carry(carrier);
    for (std::vector<Watch>& watches : worker.watches) {
      for (Watch& watch : watches) carrier.value(watch.state);
    }
  }
  for (SampleWatch& watched : impl.sample_watches) carrier.value(watched.watch.state);
  impl.book.carry(carrier);
}

std::vector<bool> Pipeline::inherit(Pipeline& before) {
  Impl& to = *impl_;
  Impl& from = *before.impl_;
  to.started = from.started;
  to.last_tick = from.last_tick;
  std::vector<bool> goes_on(to.workers.size(), false);
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i < to.workers.size(); ++i) {
    const auto id = std::find(from.ids.begin(), from.ids.end(), to.ids[i]);
    if (id == from.ids.end()) continue;
    Worker& old = from.workers[static_cast<std::size_t>(id - from.ids.begin())];
    if (old.settings != to.workers[i].settings) continue;
    bytes.clear();
    Carrier out = Carrier::saving(bytes);
    old.stage.carry(out);
    Carrier in = Carrier::restoring(bytes);
    to.workers[i].stage.carry(in);
    goes_on[i] = true;
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
