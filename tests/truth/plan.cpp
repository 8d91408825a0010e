#include "tests/truth/plan.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/truth/case.h"
#include "tests/truth/draw.h"
#include "tests/truth/model_files.h"
#include "tests/truth/visibility.h"
#include "tests/truth/wanted.h"

namespace truth {
namespace {

constexpr int kDraws = 8;

Case draw(const Wanted& want, std::size_t motion, double push, Case of, Random& random) {
  of.motion = want.motions[(want.first_motion + motion) % want.motions.size()];
  for (const std::string& effect : want.effects) draw_effect(effect, push, of, random);
  if (want.left_out != nullptr) {
    of.left_out.kind = want.left_out->kind;
    const bool signed_size = want.left_out->name == "gain_drift" ||
                             want.left_out->name == "null_drift" ||
                             want.left_out->name == "scale_drift";
    of.left_out.size =
        push * random.around(want.left_out->typical) * (signed_size ? random.sign() : 1.0);
    of.left_out.where = random.uniform(want.left_out->where_low, want.left_out->where_high);
    if (of.left_out.kind == LeftOut::Kind::elastic_shaft) {
      // A resonance between 12 and 25 Hz, lower when asked for more; see axis.h.
      const double w = 6.283185307179586 * random.uniform(12.0, 25.0) / push;
      of.left_out.size = w * w * 0.24 * of.axis.mass_kg;
    }
  }
  return of;
}

bool is_within_limits(const Case& of, const Record& record) {
  if (of.kind == Kind::linear_axis || of.kind == Kind::rotary_axis) return true;
  constexpr double kSpare_Pa = 1e5;
  if (record.least_Pa <= kSpare_Pa || record.greatest_ratio >= 0.98) return false;
  return std::all_of(record.reading_m.begin(), record.reading_m.end(),
                     [](double y_m) { return y_m > 0.02 && y_m < 0.59; });
}

Planned answer(const Case& of, Record& record) {
  Planned planned;
  planned.text = to_text(of);
  planned.of = parse_case(planned.text, of.seed);
  planned.hidden = shown_effects(planned.of);
  record = simulate(planned.of);
  planned.within_limits = is_within_limits(planned.of, record);
  for (const std::string& effect : planned.hidden) {
    planned.visibility.push_back(visibility_ratio(lacking(planned.of, effect), record));
  }
  if (planned.of.left_out.kind != LeftOut::Kind::none) {
    Case without_law = planned.of;
    without_law.left_out = LeftOut{};
    planned.visibility.push_back(visibility_ratio(without_law, record));
  }
  return planned;
}

}  // namespace

Planned plan_record(const std::string& plan, std::size_t seed, std::size_t index, Record& record) {
  std::size_t salt = 0;
  for (const char c : plan) salt = salt * 131 + static_cast<unsigned char>(c);
  Random random((seed * 1000003U + salt) * 7919U + index);
  Wanted want = wanted(plan, index, random);
  Case of = typical_case(want.kind);
  of.seed = seed * 100000 + salt % 997 * 10000 + index + 1;
  of.mismatched = want.mismatched;
  if (want.off_most > 0.0) {
    draw_plant_within(of, want.off_most);
  } else {
    draw_plant(of);
  }
  if (want.kind == Kind::single_rod) of.rod.area_rod_m2 = of.rod.area_cap_m2;  // until asked for
  if (want.condition != nullptr) want.condition->apply(of);
  if (want.disturbed) of.outside = draw_outside(want.kind, want.which_outside, random);
  double push = 1.0;
  std::size_t motion = 0;
  Planned best;
  Record best_record;
  best.condition = want.condition != nullptr ? want.condition->name : "";
  double best_score = -1.0;
  for (int attempt = 0; attempt < kDraws; ++attempt) {
    if (attempt > 0 && plan == "pairs" && attempt % 4 == 0) {
      want = wanted(plan, index, random);
      push = 1.0;
    }
    Planned planned = answer(draw(want, motion, push, of, random), record);
    const double least = planned.visibility.empty() ? want.shows
                                                    : *std::min_element(planned.visibility.begin(),
                                                                        planned.visibility.end());
    const double score = (planned.within_limits ? 10.0 : 0.0) + std::min(least, want.shows);
    if (score > best_score) {
      best_score = score;
      planned.condition = best.condition;
      best = std::move(planned);
      best_record = record;
    }
    if (best_score >= 10.0 + want.shows) break;
    if (best.within_limits && least < want.shows) push *= 1.5;
    if (!best.within_limits) ++motion;
    if (attempt == kDraws / 2) ++motion;
  }
  record = std::move(best_record);
  return best;
}

std::string file_name(std::size_t index) {
  char text[32];
  std::snprintf(text, sizeof text, "case%04zu.csv", index + 1);
  return text;
}

void write_plan(const std::string& plan, std::size_t count, std::size_t seed,
                const std::string& folder, int jobs) {
  std::vector<Planned> planned(count);
  std::vector<double> floors_m(count);
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::mutex lock;
  std::string failed;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        Record record;
        planned[i] = plan_record(plan, seed, i, record);
        floors_m[i] = record.floor_m;
        write_csv(record, folder + "/" + file_name(i));
        std::fprintf(stderr, "\r%s %zu of %zu ", plan.c_str(), ++done, count);
      } catch (const std::exception& error) {
        const std::lock_guard guard(lock);
        failed = error.what();
        next = count;
      }
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < jobs; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  std::fputs("\n", stderr);
  if (!failed.empty()) throw std::invalid_argument(failed);
  for (const Planned& one : planned) write_model(one.of.kind, folder);
  write_answers(folder + "/answers.json", plan, seed, planned, floors_m);
}

}  // namespace truth
