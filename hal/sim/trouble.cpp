#include "hal/sim/trouble.h"

namespace hal::sim {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

void Trouble::visit(config::schema::Visitor& v) {
  v.choice({"kind", "what goes wrong", true}, kind,
           {"missing", "frozen", "jump", "drift", "stale", "deaf"});
  if (kind != "deaf") v.text({"rod", "id of a spare rod sensor; empty: the rig's own"}, rod);
  if (kind == "missing" || kind == "frozen" || kind == "stale") {
    v.text({"pressure", "the transducer that it is of, in place of a rod sensor"}, pressure);
  }
  v.number({"from_s", "when it begins"}, from_s, {0.0, kInfinite});
  v.number({"to_s", "when it is over"}, to_s, {0.0, kInfinite});
  if (kind == "jump") v.number({"size_m", "added to the reading"}, size_m, {-100.0, 100.0});
  if (kind == "drift") v.number({"rate_mps", "of the reading off the rod"}, rate_mps, {-1.0, 1.0});
}

SpoiltRod::SpoiltRod(const std::vector<Trouble>& all, const std::string& id) {
  for (const Trouble& trouble : all) {
    if (trouble.rod == id && trouble.pressure.empty()) troubles_.push_back(trouble);
  }
}

bool SpoiltRod::spoil(Reading& reading, double t_s) noexcept {
  const double y_m = reading.y_m;
  bool frozen = false;
  bool deaf = false;
  for (const Trouble& trouble : troubles_) {
    if (!trouble.at(t_s)) continue;
    if (trouble.kind == "missing") {
      reading.y_m = kMissing;
      reading.quality = config::signals::Quality::bad;
    } else if (trouble.kind == "frozen") {
      reading.y_m = last_y_m_;
      frozen = true;
    } else if (trouble.kind == "jump") {
      reading.y_m += trouble.size_m;
    } else if (trouble.kind == "drift") {
      reading.y_m += trouble.rate_mps * (t_s - trouble.from_s);
    } else if (trouble.kind == "stale") {
      reading.y_m = last_y_m_;
      reading.quality = config::signals::Quality::stale;
      frozen = true;
    } else {
      deaf = true;
    }
  }
  if (!frozen) last_y_m_ = y_m;
  return deaf;
}

SpoiltPressure::SpoiltPressure(const std::vector<Trouble>& all, const std::string& id) {
  for (const Trouble& trouble : all) {
    if (trouble.pressure == id) troubles_.push_back(trouble);
  }
}

void SpoiltPressure::spoil(InputReading& reading, double t_s) noexcept {
  const double value_Pa = reading.value;
  bool frozen = false;
  for (const Trouble& trouble : troubles_) {
    if (!trouble.at(t_s)) continue;
    if (trouble.kind == "missing") {
      reading = {};
      continue;
    }
    frozen = true;
    reading.value = last_Pa_;
    if (trouble.kind == "stale") reading.quality = config::signals::Quality::stale;
  }
  if (!frozen) last_Pa_ = value_Pa;
}

void SpareConfig::visit(config::schema::Visitor& v) {
  v.text({"id", "its channel", true}, id);
  v.number({"offset_m", "added to the position"}, offset_m, {-100.0, 100.0});
  v.number({"from_s", "when the offset begins"}, from_s, {0.0, kInfinite});
  v.number({"encoder_resolution_m", "its step; 0: none"}, encoder_resolution_m, {0.0, 1e-2});
  v.number({"noise_m", "standard deviation of its noise"}, noise_m, {0.0, 1e-2});
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
  return {now ? meanwhile_ : value_, 0, config::signals::Quality::good};
}

}  // namespace hal::sim
