// Requests that are refused before anything is computed.
#include "workbench/diagnose/request.h"

#include <gmock/gmock.h>

#include <CLI/Error.hpp>

#include "config/schema/error.h"
#include "tests/workbench/diagnose/servo_bench.h"

namespace workbench::diagnose {
namespace {

using config::schema::Error;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

class DiagnoseRequest : public testing::Test, public ServoBench {
 protected:
  DiagnoseRequest() {
    request_.model = model();
    request_.records = {record("bench.csv", {.duration_s = 3.0})};
  }

  void expect_refused(int exit_code, const std::string& words) const {
    try {
      (void)prepare(request_);
      ADD_FAILURE() << "is taken";
    } catch (const Error& error) {
      EXPECT_EQ(config::schema::exit_code_of(error), exit_code) << error.what();
      EXPECT_THAT(error.what(), HasSubstr(words));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }

  DiagnosisRequest request_;
};

TEST_F(DiagnoseRequest, IsTakenWithItsRecordsAndCommand) {
  request_.holdouts = {record("other.csv", {.sample_time_s = 0.01})};
  request_.command = "spoolwatch diagnose";
  const PreparedDiagnosis prepared = prepare(request_);
  EXPECT_EQ(prepared.problem.data.records.size(), 2U);
  EXPECT_EQ(prepared.command, "spoolwatch diagnose");
}

TEST_F(DiagnoseRequest, FixedParametersAreNotFitted) {
  request_.selection.fix = {"time_constant_s"};
  request_.selection.priors = {"gain_mps_per_V=0.05+-2%"};
  const PreparedDiagnosis prepared = prepare(request_);
  ASSERT_EQ(prepared.problem.plant_parameters.size(), 1U);
  EXPECT_EQ(prepared.problem.plant_parameters[0].name, "gain_mps_per_V");
  EXPECT_NEAR(prepared.problem.plant_parameters[0].prior_sd, 0.02, 1e-3);  // of the logarithm
}

TEST_F(DiagnoseRequest, IgnoredSamplesAreAGap) {
  request_.ignored = {"1.2:1.5"};
  const PreparedDiagnosis prepared = prepare(request_);
  const greybox::Dataset& record = prepared.problem.data.records.front();
  EXPECT_EQ(record.size(), 600U - 61U);  // 200 Hz, both ends
  EXPECT_EQ(record.starts, (std::vector<std::size_t>{0, 240}));
  EXPECT_EQ(prepared.problem.data.all_mask[241], 0.0);  // settles as after any gap
}

TEST_F(DiagnoseRequest, IgnoringAHoldoutsSamplesIsTaken) {
  request_.holdouts = {record("other.csv", {.sample_time_s = 0.01})};
  request_.ignored = {"other.csv@0:2"};
  EXPECT_EQ(prepare(request_).problem.data.records.back().size(), 1000U - 201U);
}

TEST_F(DiagnoseRequest, SamplesOfWhichNoneScoreAreRefused) {
  request_.records = {record("long.csv", {.duration_s = 10.0})};
  request_.holdouts.clear();
  request_.ignored = {"2:4", "6:8"};
  expect_refused(65, "to score");
}

TEST_F(DiagnoseRequest, AShortRecordIsFittedAndScored) {
  request_.records = {record("short.csv", {.duration_s = 2.0})};
  const greybox::FitDataset data = prepare(request_).problem.data;
  EXPECT_EQ(data.training_mask.sum(), 100.0);  // the first half second is lead-in
  EXPECT_EQ(data.validation_mask.sum(), 200.0);
}

TEST_F(DiagnoseRequest, BlanksAroundNamesOfEffectsCountForNothing) {
  request_.only = {"deadband ", " backlash"};
  EXPECT_EQ(prepare(request_).problem.candidate_effects.size(), 2U);
}

TEST_F(DiagnoseRequest, OnlyAndWithoutTheSameEffectAreRefused) {
  request_.only = {"deadband"};
  request_.without = {"deadband"};
  expect_refused(2, "--without names every effect of --only: deadband");
}

TEST_F(DiagnoseRequest, AnEffectThatTheModelLacksIsNotKept) {
  request_.selection.fix = {"backlash"};
  expect_refused(
      2, "--fix backlash: the model states no size of backlash, which is sought; --without");
  request_.without = {"backlash"};
  EXPECT_NO_THROW((void)prepare(request_));
  request_.selection.fix = {"transport_delay.delay_s"};
  expect_refused(2, "--fix transport_delay.delay_s: the model states no size of transport_delay");
  request_.without.clear();
  request_.only = {"deadband"};
  EXPECT_NO_THROW((void)prepare(request_));
}

TEST_F(DiagnoseRequest, WhatTheModelLacksOfAnEffectIsSoughtUnlessItIsFixed) {
  request_.model = std::string(SPOOLWATCH_SOURCE_DIR) + "/config/models/thesis.toml";
  request_.assignments = {"effects.friction.coulomb_N=150"};
  const auto lacking = [&] {
    std::vector<std::string> names;
    for (const auto& effect : prepare(request_).problem.candidate_effects) {
      if (effect.name != "friction") continue;
      for (const auto& p : effect.parameters) names.emplace_back(p.name);
    }
    return names;
  };
  EXPECT_THAT(lacking(), Contains("static_N"));
  request_.selection.fix = {"friction.coulomb_N"};
  EXPECT_EQ(lacking().size(), 7U);
  request_.selection.fix = {"friction.static_N", "friction.stribeck_mps"};
  EXPECT_THAT(lacking(), AllOf(SizeIs(5), Not(Contains("static_N"))));
  request_.selection.fix = {"friction.static_N", "friction.stribeck_mps",
                            "friction.presliding_stiffness_N_per_m",
                            "friction.presliding_damping_N_s_per_m"};
  EXPECT_THAT(lacking(), Contains("direction_ratio"));
  const plant_sim::EffectInfo sought = prepare(request_).problem.candidate_effects.back();
  EXPECT_FALSE(greybox::effect_parameters(sought, 0).empty()) << "a search begins with a size";
  request_.selection.fix = {"friction"};
  EXPECT_TRUE(lacking().empty());
  request_.selection.fix.clear();
  request_.without = {"friction"};
  EXPECT_TRUE(lacking().empty());
  request_.without.clear();
  request_.selection.free = {"mass_kg", "friction"};
  EXPECT_TRUE(lacking().empty()) << "all of it is fitted as the model's own";
}

TEST_F(DiagnoseRequest, WrongChoicesAreRefused) {
  request_.ignored = {"1-2"};
  expect_refused(2, "is not a span");
  request_.ignored = {"7:8"};
  expect_refused(2, "no sample lies there");
  request_.ignored = {"0:1000"};
  expect_refused(65, "");
  request_.ignored.clear();
  request_.selection.fix = {"mass_kg"};
  expect_refused(78, "is no parameter of this model");
}

TEST_F(DiagnoseRequest, HoldoutThatIsFittedTooIsRefused) {
  request_.holdouts = {file("./bench.csv")};
  expect_refused(2, "is fitted too");
}

TEST_F(DiagnoseRequest, RecordGivenTwiceIsRefused) {
  request_.records.push_back(request_.records[0]);
  expect_refused(2, "is given twice");
}

TEST_F(DiagnoseRequest, HoldoutGivenTwiceIsRefused) {
  const std::string other = record("other.csv", {.sample_time_s = 0.01});
  request_.holdouts = {other, file("./other.csv")};
  expect_refused(2, "is given twice");
}

TEST_F(DiagnoseRequest, HoldoutBesideASplitIsRefused) {
  EXPECT_THROW(diagnose_with({model(), request_.records[0], "--fit", "first-half", "--holdout",
                              record("other.csv", {})}),
               CLI::ExcludesError);
}

TEST_F(DiagnoseRequest, OutputsThatCouldNotBeWrittenAreRefusedAtOnce) {
  request_.output = file("nowhere/better.toml");
  expect_refused(1, "does not exist");
  request_.output = file("");
  expect_refused(1, "is a folder");
  request_.output = "";
  request_.report = "/proc/report.html";
  if (geteuid() != 0) expect_refused(1, "cannot be written");
}

TEST_F(DiagnoseRequest, OutputsOverInputsOrOverEachOtherAreRefused) {
  request_.output = request_.records[0];
  expect_refused(2, "would overwrite an input");
  request_.output = "";
  request_.json = model();
  expect_refused(2, "would overwrite an input");
  request_.json = file("d.json");
  request_.report = file("d.json");
  expect_refused(2, "is the file of two outputs");
}

TEST_F(DiagnoseRequest, ShortRecordIsBadData) {
  request_.records = {record("short.csv", {.duration_s = 1.0})};
  expect_refused(65, "too short");
}

TEST_F(DiagnoseRequest, RecordTooSlowToShowMotionIsBadData) {
  request_.records = {record("slow.csv", {.duration_s = 100.0, .sample_time_s = 1.0})};
  expect_refused(65, "is sampled every 1 s");
}

TEST_F(DiagnoseRequest, UnknownEffectIsBadConfiguration) {
  request_.assignments = {"effects.fricton.coulomb_N=100"};
  expect_refused(78, "fricton");
}

}  // namespace
}  // namespace workbench::diagnose
