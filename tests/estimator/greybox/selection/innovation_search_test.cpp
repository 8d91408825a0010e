// Searches on disturbed records of the independent simulator (tests/truth).
#include "estimator/greybox/selection/innovation_search.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "estimator/greybox/selection/first_stage.h"
#include "estimator/greybox/selection/resonance_or_line.h"
#include "estimator/greybox/selection/settled_trials.h"
#include "estimator/greybox/selection/structure_search.h"
#include "tests/estimator/greybox/selection/truth_records.h"

namespace estimator::greybox::selection {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

InnovationSearch searched(const std::string& spec, std::size_t seed) {
  SearchContext context = diagnose_test::context_of(spec, seed);
  context.options.threads = 2;
  return search_innovations(context, first_stage(context), {});
}

/// The search after that by simulations, whose rounds it knows but not their outcome.
InnovationSearch searched_after_simulations(const std::string& spec, std::size_t seed) {
  SearchContext context = diagnose_test::context_of(spec, seed);
  context.options.threads = 2;
  SearchStart start = start_search(context);
  start.branch.stage = start.first;
  return search_innovations(context, start.first, start.branch);
}

// Without the line, a resonance passes for the oil that the pulsation shakes.
TEST(LongInnovationSearch, AnEffectTakenBeforeALineIsExchangedForTheRightOne) {
  const InnovationSearch found = searched_after_simulations(
      "motion=multisine,length_s=12,entrained_air.fraction_ratio=0.3,"
      "outside.pulsation_Pa=200000,outside.pulsation_Hz=14",
      5004);
  ASSERT_FALSE(found.rounds.empty());
  EXPECT_THAT(found.rounds.front().candidates.front().effect, testing::Ne("entrained_air"));
  EXPECT_THAT(found.final.model.added, ElementsAre("entrained_air"));
  EXPECT_FALSE(found.physics_missing());
  for (const InnovationRound& round : found.rounds) {
    const auto after_taken = round.candidates.begin() + (round.taken ? 1 : 0);
    EXPECT_TRUE(std::is_sorted(after_taken, round.candidates.end(),
                               [](const InnovationCandidate& a, const InnovationCandidate& b) {
                                 if (a.settled != b.settled) return a.settled;
                                 return a.gain_nats > b.gain_nats;
                               }));
  }
}

FreeParameter named(const std::string& name) {
  FreeParameter parameter;
  parameter.name = name;
  return parameter;
}

// The same effect may be in a model with more or fewer refinements.
TEST(SimulatedEffectsMemo, KnowsAModelByItsParameters) {
  Round round;
  round.before.fitted.parameters = {named("mass_kg"), named("second_mass.resonance_Hz")};
  Candidate friction;
  friction.effects = {"friction"};
  friction.fitted_at_all = true;
  round.candidates = {friction};
  SimulatedEffectsMemo memo({round});

  ModelStage model;
  model.fitted.parameters = {named("second_mass.resonance_Hz"), named("mass_kg")};
  ASSERT_TRUE(memo.knows(model));
  const SimulatedEffects& known = memo.beside({}, model);
  ASSERT_THAT(known.effects, SizeIs(1));
  EXPECT_EQ(known.effects.front().effect, "friction");
  model.fitted.parameters.push_back(named("second_mass.sensor_ratio"));
  EXPECT_FALSE(memo.knows(model));
}

// A flow at its limit passes no pulsation; a linear response to it would leave its difference.
TEST(LongInnovationSearch, APulsationBehindALimitedFlowLeavesNothing) {
  const InnovationSearch found = searched(
      "motion=multisine,length_s=15,flow_saturation.limit_m3ps=6.33e-5,"
      "outside.pulsation_Pa=130000,outside.pulsation_Hz=19.3725",
      539180049);
  EXPECT_THAT(found.final.model.added, ElementsAre("flow_saturation"));
  EXPECT_FALSE(found.physics_missing());
  EXPECT_LT(found.final.noise.noise.disturbance_sd, 1.0);
}

TEST(InnovationSearch, ALinesFrequencyIsFoundToASmallPartOfABin) {
  constexpr double kFrequency_Hz = 41.3217;
  const InnovationSearch found =
      searched("motion=multisine,length_s=20,outside.shake_m=4e-5,outside.shake_Hz=41.3217", 77);
  EXPECT_THAT(found.final.model.added, IsEmpty());
  ASSERT_THAT(found.final.noise.lines, SizeIs(1));
  EXPECT_NEAR(found.final.noise.lines.front().frequency_Hz, kFrequency_Hz, 1.5e-4);
}

/// A linear axis of the independent simulator and the model that knows nothing of what it hides.
SearchContext axis_context(const std::string& spec, std::size_t seed) {
  plant_sim::ModelFile model = plant_sim::load_model(std::string(SPOOLWATCH_SOURCE_DIR) +
                                                     "/config/models/force_driven_axis.toml");
  *model.value("mass_kg") = 100.0;
  *model.value("damping_N_s_per_m") = 200.0;
  *model.value("gain_N_per_V") = 35.0;
  Dataset record = diagnose_test::dataset_of(truth::simulate(truth::parse_case(spec, seed)));
  SearchContext context{make_problem(std::move(model), fit_dataset({std::move(record)}, {})), {}};
  context.options.threads = 2;
  return context;
}

// A random force moves the rod by many times the play: only a filter that knows the gap follows.
TEST(InnovationSearch, APlayIsFoundThroughARandomForce) {
  const SearchContext context = axis_context(
      "rig=linear_axis,motion=multisine,length_s=15,backlash.width_m=0.0002,"
      "outside.force_N=3.2,outside.corner_Hz=1.7",
      88);
  const InnovationSearch found = search_innovations(context, first_stage(context), {});
  EXPECT_THAT(found.final.model.added, ElementsAre("backlash"));
  EXPECT_NEAR(found.final.model.fitted.value("backlash.width_m"), 2e-4, 4e-6);
  EXPECT_FALSE(found.physics_missing());
}

/// A search by simulations on a record, with the second effect where there is a first.
SearchStart two_effects(const SearchContext& context) {
  SearchStart start = start_search(context);
  if (start.branch.stage.added.size() == 1) add_second_effect(context, start);
  return start;
}

InnovationStage settled_first(const SearchContext& context, const SearchStart& start) {
  return settled(context, start.first, {}, Settling::fully, wide(context.options.threads));
}

// One by one, a leak and friction would come first, and the two only after them.
TEST(InnovationSearch, GoesOnFromAHeldModelThatExplainsTheRecord) {
  SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=12,null_bias.offset_V=0.1,deadband.half_width_V=0.15,"
      "outside.force_N=20",
      83);
  const SearchStart start = two_effects(context);
  ASSERT_THAT(start.branch.stage.added, testing::UnorderedElementsAre("null_bias", "deadband"));
  EXPECT_TRUE(explains_record(context, settled_first(context, start), start.branch.stage));
  const InnovationSearch found = search_innovations(context, start.first, start.branch);
  EXPECT_THAT(found.final.model.added, testing::UnorderedElementsAre("null_bias", "deadband"));
  EXPECT_FALSE(found.physics_missing());
  ASSERT_GE(found.rounds.size(), 2);
  const InnovationCandidate& taken = found.rounds[1].candidates.front();
  EXPECT_EQ(taken.effect, start.branch.stage.added.front());
  EXPECT_THAT(taken.taken_with_it, ElementsAre(start.branch.stage.added.back()));
}

TEST(ExplainsRecord, NotWhereALawIsLeft) {
  SearchContext context = diagnose_test::context_of(
      "motion=multisine,length_s=12,null_bias.offset_V=0.1,left_out=cubic_damping,"
      "left_out.size=100000,outside.force_N=20",
      84);
  const SearchStart start = start_search(context);
  ASSERT_THAT(start.branch.stage.added, SizeIs(1));
  const InnovationStage before = settled_first(context, start);
  const InnovationStage held = settled(context, start.branch.stage, before.noise, Settling::once,
                                       wide(context.options.threads));
  EXPECT_LT(penalised(held), penalised(before) - 100.0);
  EXPECT_GT(largest_curve_nats(held), kCurve_nats);
  EXPECT_FALSE(explains_record(context, before, start.branch.stage));
  EXPECT_FALSE(explains_record(context, before, start.first)) << "nothing is held";
}

// A second mass that does not damp rings like the line; what it is, the line says in three numbers.
TEST(InnovationSearch, ALineTakesThePlaceOfAResonanceThatDoesNotDamp) {
  SearchContext context = axis_context(
      "rig=linear_axis,motion=multisine,length_s=15,outside.line_N=25,outside.line_Hz=29.17", 89);
  std::erase_if(context.problem.candidate_effects,
                [](const auto& effect) { return effect.name != "second_mass"; });
  const InnovationStage first =
      settled(context, first_stage(context), {}, Settling::fully, wide(context.options.threads));
  EXPECT_FALSE(line_for_resonance(context, first));
  InnovationStage with = first;
  for (InnovationStage& one : settle_trials(context, first, effect_trials(first)))
    with = std::move(one);
  ASSERT_THAT(with.model.added, ElementsAre("second_mass"));
  const std::optional<LineInstead> instead = line_for_resonance(context, with);
  ASSERT_TRUE(instead);
  EXPECT_THAT(instead->stage.model.added, IsEmpty());
  ASSERT_THAT(instead->stage.noise.lines, SizeIs(1));
  EXPECT_NEAR(instead->stage.noise.lines.front().frequency_Hz, 29.17, 2e-3);
}

}  // namespace
}  // namespace estimator::greybox::selection
