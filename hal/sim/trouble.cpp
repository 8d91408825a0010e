#include "hal/sim/trouble.h"

namespace hal::sim {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

void Trouble::visit(config::schema::Visitor& v) {
  v.choice({"kind", "what goes wrong", true}, kind, {"missing", "frozen", "jump", "stale", "deaf"});
  v.number({"from_s", "when it begins"}, from_s, {0.0, kInfinite});
  v.number({"to_s", "when it is over"}, to_s, {0.0, kInfinite});
  if (kind == "jump") v.number({"size_m", "added to the reading"}, size_m, {-100.0, 100.0});
}

void SpareConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "its channel", true}, id);
  v.number({"offset_m", "added to the position"}, offset_m, {-100.0, 100.0});
  v.number({"from_s", "when the offset begins"}, from_s, {0.0, kInfinite});
}

void SwitchConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "its channel", true}, id);
  v.number({"value", "what it reads"}, value, {-1e12, 1e12});
  v.number({"from_s", "from then on"}, from_s, {0.0, kInfinite});
  v.number({"to_s", "until then"}, to_s, {0.0, kInfinite});
  v.number({"meanwhile", "it reads this"}, meanwhile, {-1e12, 1e12});
  v.boolean({"missing", "or nothing"}, missing);
}

InputReading Switch::read(const Tick& tick) noexcept {
  const double t_s = static_cast<double>(tick.nominal_ns) * 1e-9;
  const bool now = t_s >= from_s_ && t_s < to_s_;
  if (now && missing_) return {};
  return {now ? meanwhile_ : value_, 0, Quality::good};
}

}  // namespace hal::sim
