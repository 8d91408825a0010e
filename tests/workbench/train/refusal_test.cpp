// A trained file and a configuration that it does not fit.
#include <gtest/gtest.h>

#include "estimator/fdi/snapshot.h"
#include "tests/workbench/train/trained_rig.h"

namespace workbench::train {
namespace {

TEST_F(Train, IsRefusedForAnotherRigSampleTimeOrEstimatorInOneLineWithExitCode78) {
  train_all();
  EXPECT_EQ(refusal(), "");
  EXPECT_NE(refusal("other").find("was trained on rig 'small', this is 'other'"),
            std::string::npos);
  EXPECT_NE(refusal("small", 0.004).find("was trained at 0.005 s, the samples come every 0.004 s"),
            std::string::npos);
  const auto refused_with = [this](const std::string& from, const std::string& to) {
    write_config(with(from, to));
    return refusal();
  };
  const auto expect = [](const std::string& line, const std::string& part) {
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_NE(line.find("trained.toml: "), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  };
  const std::string other = "sliding.b1 was trained with other settings: ";
  expect(refused_with("window_s = 1.0", "window_s = 0.5"),
         other + "window_s = 1.0; allowed: window_s = 0.5");
  expect(refused_with("arx111", "arx211"),
         other + "structure = 'arx111'; allowed: structure = 'arx211'");
  expect(refused_with("offset_m = 0.305", "offset_m = 0.3"),
         other + "offset_m = 0.305; allowed: offset_m = 0.3");
  expect(
      refused_with("offset_m = 0.305", "offset_m = 0.305\nfilter = \"low\"\nfilter_high_Hz = 20.0"),
      other + "filter = 'none'; allowed: filter = 'low'");
  expect(refused_with("stride_s = 0.02", "stride_s = 0.04"),
         other + "stride_s = 0.02; allowed: stride_s = 0.04");
  expect(refused_with("block_s = 2.0", "block_s = 1.0"),
         "was trained on blocks of 2 s; allowed: block_s of [[cusum]] gain, 1 s");
  expect(refused_with("[\"sliding.a1\", \"sliding.b1\"]", "[\"sliding.b1\"]"),
         "was trained on sliding.a1, sliding.b1; allowed: sliding.b1");
  expect(refused_with("id = \"gain\"", "id = \"new\""), "has no entry for [[cusum]] new");
}

TEST_F(Train, IsRefusedInAnotherLayoutOrOtherUnits) {
  train_all();
  std::ifstream in(folder_ / "trained.toml");
  const std::string file((std::istreambuf_iterator<char>(in)), {});
  const auto refused_with = [&](const std::string& from, const std::string& to) {
    std::string text = file;
    std::ofstream(folder_ / "trained.toml") << text.replace(text.find(from), from.size(), to);
    return refusal();
  };
  EXPECT_NE(refused_with("trained_version = 2", "trained_version = 1").find("trained_version"),
            std::string::npos);
  EXPECT_NE(refused_with("units = \"m, V, s\"", "units = \"mm, V, s\"")
                .find("units: was trained in 'mm, V, s'; allowed: m, V, s"),
            std::string::npos);
}

TEST_F(Train, HasTheSettingsOfEverySourceBehindTheOneThatItIsTrainedOn) {
  // A vote over an estimator and the reading: the estimator's window is part of it.
  const std::string text = kConfig;
  const std::string voted =
      text.substr(0, text.find("[[cusum]]")) +
      "[[voter]]\nid = \"vote\"\nchannels = [\"sliding.b1\", \"sample.y_m\"]\ntolerance = 1.0\n";
  const auto settings = [&](double window_s) {
    write_config(voted);
    fdi::PipelineConfig config;
    Document::load(folder_ / "config.toml").read_part([&](Visitor& v) { config.visit(v); });
    config.estimators[0].window_s = window_s;
    return fdi::settings_of({"vote.value"}, config, "here").front();
  };
  EXPECT_EQ(settings(1.0), settings(1.0));
  EXPECT_NE(settings(1.0).find("tolerance = 1.0"), std::string::npos) << settings(1.0);
  const fdi::FingerprintDifference differs = fdi::difference(settings(1.0), settings(0.5));
  EXPECT_EQ(differs.found, "window_s = 1.0");
  EXPECT_EQ(differs.expected, "window_s = 0.5");
}

}  // namespace
}  // namespace workbench::train
