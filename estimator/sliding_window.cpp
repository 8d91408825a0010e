#include "estimator/sliding_window.h"

#include <numeric>
#include <vector>

#include "config/schema/error.h"
#include "estimator/regressor.h"
#include "estimator/solve.h"

namespace estimator {
namespace {

/// Contents of a block, or of several merged ones, besides the factor.
struct Tally {
  int rows = 0;
  ExcitationRange span;

  void add(const Tally& other) noexcept {
    rows += other.rows;
    span.add(other.span);
  }
};

}  // namespace

struct SlidingWindow::State {
  explicit State(const SlidingConfig& c)
      : config(c),
        block(std::gcd(c.window, c.stride)),
        blocks(c.window / block),
        columns(c.structure.size() + 1),
        memory(SquareRootInformation::size(columns) * static_cast<std::size_t>(blocks + 1)),
        tallies(static_cast<std::size_t>(blocks + 1)),
        regressor(c.structure) {
    reset();
  }

  void reset() noexcept {
    regressor.reset();
    head = 0;
    old_side = 0;
    new_side = 0;
    in_block = 0;
    blocks_to_estimate = config.stride / block;
    open().clear();
    tallies[0] = {};
    running().clear();
    running_tally = {};
  }

  // Slots form a ring of blocks + 1: `old_side` merged ones from `head`, then `new_side` single
  // ones, then the one being filled.
  int slot(int i) const noexcept { return (head + i) % (blocks + 1); }
  SquareRootInformation factor(int i) noexcept {
    return {columns, memory.data() +
                         SquareRootInformation::size(columns) * static_cast<std::size_t>(slot(i))};
  }
  Tally& tally(int i) noexcept { return tallies[static_cast<std::size_t>(slot(i))]; }
  SquareRootInformation open() noexcept { return factor(old_side + new_side); }
  SquareRootInformation running() noexcept { return {columns, running_memory.values.data()}; }

  /// True when an estimate is due after this sample.
  bool end_sample() noexcept {
    if (++in_block < block) return false;
    in_block = 0;
    running().merge(open());
    running_tally.add(tally(old_side + new_side));
    ++new_side;
    if (old_side + new_side > blocks) drop_oldest();
    open().clear();
    tally(old_side + new_side) = {};
    if (--blocks_to_estimate > 0) return false;
    blocks_to_estimate = config.stride / block;
    return true;
  }

  void drop_oldest() noexcept {
    if (old_side == 0) turn_over();
    head = slot(1);
    --old_side;
  }

  /// Makes the new side the old one: each block merged with all that follow it.
  void turn_over() noexcept {
    for (int i = new_side - 2; i >= 0; --i) {
      factor(i).merge(factor(i + 1));
      tally(i).add(tally(i + 1));
    }
    old_side = new_side;
    new_side = 0;
    running().clear();
    running_tally = {};
  }

  /// The window's factor, in `out`.
  void whole(SquareRootInformation out, Tally& out_tally) noexcept {
    out.copy(running());
    out_tally = running_tally;
    if (old_side > 0) {
      out.merge(factor(0));
      out_tally.add(tally(0));
    }
  }

  SlidingConfig config;
  int block;
  int blocks;
  int columns;
  std::vector<double> memory;
  std::vector<Tally> tallies;
  Regressor regressor;
  SquareRootInformationMemory running_memory{};
  Tally running_tally;
  int head = 0;
  int old_side = 0;
  int new_side = 0;
  int in_block = 0;
  int blocks_to_estimate = 0;
};

SlidingWindow::SlidingWindow(const SlidingConfig& config) {
  if (config.window < 1 || config.window > 10'000'000 || config.stride < 1 ||
      config.stride > config.window) {
    throw config::schema::UsageError("sliding window: window " + std::to_string(config.window) +
                                     ", stride " + std::to_string(config.stride) +
                                     "; allowed: 1 <= stride <= window <= 10000000 samples");
  }
  state_ = std::make_unique<State>(config);
}
SlidingWindow::~SlidingWindow() = default;
SlidingWindow::SlidingWindow(SlidingWindow&&) noexcept = default;
SlidingWindow& SlidingWindow::operator=(SlidingWindow&&) noexcept = default;

bool SlidingWindow::push(double u_V, double y_m) noexcept {
  State& s = *state_;
  Tally& tally = s.tally(s.old_side + s.new_side);
  if (s.regressor.push(u_V, y_m)) {
    s.open().absorb(s.regressor.row());
    ++tally.rows;
    tally.span.add(u_V, y_m);
  }
  return s.end_sample();
}

bool SlidingWindow::gap(long long samples) noexcept {
  State& s = *state_;
  s.regressor.reset();
  // Beyond a whole window nothing is left; further strides change nothing.
  const long long enough = s.config.window + s.config.stride;
  if (samples > enough) samples -= (samples - enough) / s.config.stride * s.config.stride;
  bool due = false;
  for (long long i = 0; i < samples; ++i) due |= s.end_sample();
  return due;
}

void SlidingWindow::reset() noexcept { state_->reset(); }

void SlidingWindow::serialize(StateArchive& archive) {
  State& s = *state_;
  archive.fixed(s.memory);
  archive.fixed(s.tallies);
  archive.value(s.regressor);
  archive.value(s.running_memory);
  archive.value(s.running_tally);
  for (int* count : {&s.head, &s.old_side, &s.new_side, &s.in_block, &s.blocks_to_estimate}) {
    archive.value(*count);
  }
  const bool sane = s.head >= 0 && s.head <= s.blocks && s.old_side >= 0 && s.new_side >= 0 &&
                    s.old_side + s.new_side <= s.blocks && s.in_block >= 0 && s.in_block < s.block;
  if (!sane) {
    archive.fail();
    reset();
  }
}

Estimate SlidingWindow::estimate() const noexcept {
  State& s = *state_;
  SquareRootInformationMemory memory;
  SquareRootInformation whole(s.columns, memory.values.data());
  Tally tally;
  s.whole(whole, tally);
  Estimate out = solve(triangle(whole), tally.rows, s.config.limits);
  const auto refuse = [&out](Reason reason) {
    out.valid = false;
    out.reason = reason;
  };
  if (s.old_side + s.new_side < s.blocks) {
    refuse(Reason::too_short);
  } else if (tally.rows < s.config.limits.min_fill * s.config.window) {
    refuse(Reason::gap);
  } else if (out.reason != Reason::too_short && !tally.span.excited(s.config.limits)) {
    refuse(Reason::not_excited);
  }
  return out;
}

}  // namespace estimator
