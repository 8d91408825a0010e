#include "estimator/greybox/selection/packed_linearisation.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace estimator::greybox::selection {
namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// The entries of matrices of one fixed size, each over all of them.
template <class Matrix>
std::vector<std::vector<double>> packed(const std::vector<Matrix>& all) {
  if (all.empty()) return {};
  std::vector<std::vector<double>> entries(static_cast<std::size_t>(all.front().size()));
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const auto at = [&](const Matrix& one) { return one.data()[e]; };
    const double first = at(all.front());
    if (std::all_of(all.begin(), all.end(),
                    [&](const Matrix& one) { return same_bits(at(one), first); })) {
      entries[e] = {first};
      continue;
    }
    entries[e].resize(all.size());
    std::transform(all.begin(), all.end(), entries[e].begin(), at);
  }
  return entries;
}

template <class Matrix>
std::vector<Matrix> unpacked(const std::vector<std::vector<double>>& entries, std::size_t samples) {
  std::vector<Matrix> all(entries.empty() ? 0 : samples);
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (std::size_t e = 0; e < entries.size(); ++e)
      all[k].data()[e] = entries[e].size() == 1 ? entries[e].front() : entries[e][k];
  }
  return all;
}

std::size_t numbers_in(const std::vector<std::vector<double>>& entries) {
  std::size_t sum = 0;
  for (const std::vector<double>& entry : entries) sum += entry.size();
  return sum;
}

}  // namespace

PackedLinearisation::PackedLinearisation(const disturbance::Linearisation& linear)
    : samples_(linear.transition.size()),
      transition_(packed(linear.transition)),
      from_supply_(packed(linear.from_supply)) {
  assert(linear.from_supply.size() == samples_);
  rest_.states = linear.states;
  rest_.force = linear.force;
  rest_.supply = linear.supply;
  rest_.force_place = linear.force_place;
  rest_.speed_mps = linear.speed_mps;
  rest_.gap_m = linear.gap_m;
}

disturbance::Linearisation PackedLinearisation::unpacked() const {
  disturbance::Linearisation linear = rest_;
  linear.transition = selection::unpacked<disturbance::StateMatrix>(transition_, samples_);
  linear.from_supply = selection::unpacked<disturbance::StateVector>(from_supply_, samples_);
  return linear;
}

std::size_t PackedLinearisation::size_bytes() const {
  return sizeof(double) * (numbers_in(transition_) + numbers_in(from_supply_) +
                           rest_.speed_mps.size() + rest_.gap_m.size());
}

}  // namespace estimator::greybox::selection
