#include "workbench/compare/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/schema/error.h"
#include "workbench/fit/ignored_spans.h"
#include "workbench/present/dataset_notes.h"
#include "workbench/present/printed_axis.h"

namespace workbench::compare {
namespace {

using config::schema::UsageError;

/// Samples between `from_s` and `to_s`.
greybox::Dataset part_between(const greybox::Dataset& whole, double from_s, double to_s) {
  const auto index = [&](double t_s) {
    return static_cast<std::size_t>(std::lower_bound(whole.t_s.begin(), whole.t_s.end(), t_s) -
                                    whole.t_s.begin());
  };
  const std::size_t from = index(from_s);
  const std::size_t to = index(to_s);
  const double least_s = 2.0;
  if (from >= to || static_cast<double>(to - from) * whole.sample_time_s < least_s) {
    throw UsageError(
        fmt::format("--from, --to: leave less than 2 s of {}, which is from {:.6g} to {:.6g} s",
                    whole.name, whole.t_s.front(), whole.t_s.back()));
  }
  greybox::Dataset part = greybox::part(whole, from, to);
  part.notes = whole.notes;
  part.gaps = whole.gaps;
  return part;
}

}  // namespace

PreparedComparison prepare(const CompareRequest& request) {
  PreparedComparison out;
  out.model = plant_sim::load_model(request.model, request.assignments);
  const present::PrintedAxis axis(present::motion_of(out.model));
  std::vector<config::record::Record> records{
      config::record::read_record(request.record, request.reading)};
  out.units = config::record::units_of(records.front());
  if (!request.ignored.empty()) fit::cut_ignored(request.ignored, {request.record}, records);
  out.record = greybox::dataset_of(records.front());
  if (!std::isinf(request.from_s) || !std::isinf(request.to_s)) {
    out.record = part_between(out.record, request.from_s, request.to_s);
  }
  present::note_against_model(out.model, out.record);
  if (request.observer_per_s * out.record.sample_time_s >= 1.0) {
    throw UsageError("--observer: is too fast for samples every " +
                     std::to_string(out.record.sample_time_s) +
                     " s; allowed: below 1 / sample time");
  }
  return out;
}

}  // namespace workbench::compare
