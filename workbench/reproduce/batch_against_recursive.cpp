// The same 60 s through batch least squares over whole periods and through recursive least squares.
//
// The source prints neither the start nor the weights of its recursion. Both starts are shown; the
// forgetting factor is solved so that the greatest offset is the printed one, and the printed
// variance then judges it.
#include <fmt/format.h>

#include "workbench/reproduce/experiment.h"
#include "workbench/reproduce/spread.h"
#include "workbench/reproduce/tolerance.h"

namespace workbench::reproduce {
namespace {

using estimator::Structure;

constexpr double kPrintedOffset = 3.1607e-7;
void add_batch(std::vector<ReproducedRow>& rows, const JudgedRun& whole) {
  rows.push_back(judged("batch: J, in step, m2", 9.1157e-4, whole.cost_m2, "cost, in step",
                        "over all 30 periods, the first with its start-up"));
  rows.push_back(judged("batch: J, one sample out of step, m2", 9.1157e-4, whole.cost_late_m2,
                        "cost, out of step", "as for E, the guess that comes close"));
  rows.push_back(judged("batch: mean b1, m/V", 1.9672e-4, whole.b1.mean, "mean b1"));
  rows.push_back(judged("batch: greatest offset of b1, m/V", 4.193e-9, whole.b1.offset, "spread",
                        "from period 2 on; a steady noise-free loop repeats itself exactly"));
  rows.push_back(judged("batch: variance of b1, (m/V)2", 2.2131e-18, whole.b1.variance, "spread",
                        "as the offset"));
}

/// A guess at the printed spread of the batch: buffers a few samples short of a period drift along
/// the sine.
void add_short_buffers(std::vector<ReproducedRow>& rows, const Structure& structure,
                       const ScenarioRecord& record) {
  std::string offsets;
  std::string variances;
  for (const std::size_t window : {399, 398, 397, 396}) {
    const Spread b1 = judge_batch(structure, record, window).b1;
    offsets += fmt::format("{}{:.1e}", offsets.empty() ? "" : ", ", b1.offset);
    variances += fmt::format("{}{:.1e}", variances.empty() ? "" : ", ", b1.variance);
  }
  rows.push_back(judged("batch over 399, 398, 397, 396 samples: offset of b1, m/V", 4.193e-9,
                        offsets, "information",
                        "buffers just short of a period drift along the sine: a guess"));
  rows.push_back(judged("batch over 399, 398, 397, 396 samples: variance, (m/V)2", 2.2131e-18,
                        variances, "information"));
}

void add_recursive(std::vector<ReproducedRow>& rows, const std::string& name,
                   const JudgedRun& result, const char* offset_rule, const char* spread_rule) {
  rows.push_back(judged(name + ": J, in step, m2", 4.277e-5, result.cost_m2, "recursive cost",
                        fmt::format("one sample out of step {:.4g}", result.cost_late_m2)));
  rows.push_back(judged(name + ": mean b1, m/V", 1.9672e-4, result.b1.mean, "mean b1, recursive"));
  rows.push_back(
      judged(name + ": greatest offset of b1, m/V", kPrintedOffset, result.b1.offset, offset_rule));
  rows.push_back(
      judged(name + ": variance of b1, (m/V)2", 2.7153e-14, result.b1.variance, spread_rule));
}

}  // namespace

std::vector<ReproducedRow> batch_against_recursive() {
  const Structure structure = estimator::parse_structure("arx111");
  const ScenarioRecord record = run(calibrated(), 60.0);
  const JudgedRun whole = judge_batch(structure, record);
  std::vector<ReproducedRow> rows;
  add_batch(rows, whole);
  add_short_buffers(rows, structure, record);
  add_recursive(rows, "recursive, P(0) = 1e8 I", judge_recursive(structure, record, 1.0, false),
                "spread", "spread");
  add_recursive(rows, "recursive, warm start", judge_recursive(structure, record, 1.0, true),
                "spread", "spread");
  const double forgetting = forgetting_with_offset(structure, record, kPrintedOffset);
  const JudgedRun solved = judge_recursive(structure, record, forgetting, true);
  add_recursive(rows, fmt::format("recursive, forgetting {:.4f} (solved)", forgetting), solved,
                "solved for", "spread, recursive");
  rows.push_back(judged("b1 varies more in the recursion than in the batch", std::string("yes"),
                        std::string(solved.b1.variance > whole.b1.variance ? "yes" : "no"), "words",
                        "printed: 1.2269e4 times"));
  rows.push_back(judged("J, recursive over batch, both in step", 4.277e-5 / 9.1157e-4,
                        solved.cost_m2 / whole.cost_m2, "recursive cost",
                        "in step the batch has no delay to pay for"));
  rows.push_back(judged("J, recursive in step over batch out of step", 4.277e-5 / 9.1157e-4,
                        solved.cost_m2 / whole.cost_late_m2, "recursive cost"));
  return rows;
}

}  // namespace workbench::reproduce
