// A session keeps names, files and its state, after refused changes too.
#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <map>
#include <memory>

#include "config/record/record.h"
#include "config/schema/error.h"
#include "config/schema/read_file.h"
#include "tests/file_size_limit.h"
#include "tests/workbench/serve/study_page.h"
#include "workbench/serve/study.h"

namespace workbench::serve {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_F(StudyPage, ASessionGoesOnWhereItEnded) {
  ASSERT_EQ(page.post("ignore", {{"spans", {"3:5"}}}).status, 200);
  const SessionFolder folder(page.session);
  Study again(folder);
  const ordered_json state = again.state();
  EXPECT_EQ(state["record"], "multisine.csv");
  EXPECT_EQ(state["model"], "thesis.toml");
  EXPECT_THAT(state["ignored"], testing::ElementsAre("3:5"));
  EXPECT_EQ(state["notice"], "");
  page.put("session.json", "{\"nodes\": [1, {\"model\": 3}]}");
  EXPECT_EQ(Study(folder).state()["record"], "");
}

TEST_F(StudyPage, ASessionThatCannotBeReadIsKeptAndSaid) {
  const SessionFolder folder(page.session);
  const auto text_of = [&](const std::string& name) {
    return config::schema::read_file(page.session / name, config::schema::kMiB).text;
  };
  const auto begun_anew = [&](const std::string& why, const std::string& kept) {
    Study study(folder);
    const std::string notice = study.state()["notice"];
    EXPECT_THAT(notice, testing::HasSubstr("session.json: " + why)) << notice;
    EXPECT_THAT(notice, testing::HasSubstr("kept as " + kept));
    EXPECT_EQ(study.state()["record"], "");
    study.open_record("multisine.csv");
    EXPECT_EQ(Study(folder).state()["notice"], "") << "the next one goes on";
  };
  page.put("commands.sh", "#!/bin/sh\nspoolwatch fit\n");
  std::string number;
  for (const std::string& damaged :
       {std::string("{\"record\": \"multi"), std::string(), std::string("[1]"),
        std::string("{\"record\": []}"), std::string("{\"nodes\": {}}")}) {
    page.put("session.json", damaged);
    const std::string why = damaged.starts_with("[")                     ? "is no JSON object"
                            : damaged.find("[]") != std::string::npos    ? "record is no text"
                            : damaged.find("nodes") != std::string::npos ? "nodes is no list"
                                                                         : "is no JSON";
    const std::string kept = "session-damaged" + number + ".json";
    begun_anew(why, kept);
    EXPECT_EQ(text_of(kept), damaged);
    number = number.empty() ? "-2" : "-" + std::to_string(std::stoi(number.substr(1)) + 1);
  }
  EXPECT_EQ(text_of("commands-before.sh"), "#!/bin/sh\nspoolwatch fit\n");
  std::filesystem::remove(page.session / "session.json");
  std::filesystem::create_directory(page.session / "session.json");
  begun_anew("cannot be read", "session-damaged" + number + ".json");

  // its files are gone
  page.put("session.json", "{\"record\": \"gone.csv\", \"model\": \"thesis.toml\"}");
  EXPECT_THAT(Study(folder).state()["notice"].get<std::string>(), testing::HasSubstr("gone.csv"));
}

TEST_F(StudyPage, ModelsFittedAgainAreNumbered) {
  for (const char* const expected :
       {"thesis-fitted.toml", "thesis-fitted-2.toml", "thesis-fitted-3.toml"}) {
    ASSERT_EQ(page.post("fit").status, 200);
    EXPECT_EQ(finished()["trial"], expected);
    ASSERT_EQ(page.post("accept").status, 200);
  }
  ASSERT_EQ(page.post("add", {{"effect", "null_bias"}}).status, 200);
  EXPECT_EQ(page.state()["trial"], "thesis+null_bias.toml");
}

TEST_F(StudyPage, AFolderThatIsLostIsSaidAndItsSessionIsWrittenAgain) {
  ASSERT_EQ(page.post("add", {{"effect", "null_bias"}}).status, 200);
  ASSERT_EQ(page.post("accept").status, 200);
  const ordered_json before = page.state();
  EXPECT_EQ(before["trouble"], "");
  const std::filesystem::path away = page.folder / "away";
  std::filesystem::rename(page.session, away);
  EXPECT_EQ(page.post("add", {{"effect", "friction"}}).status, 422);
  const ordered_json lost = page.state();
  EXPECT_EQ(lost["trouble"], page.session.string() + ": is gone");
  EXPECT_EQ(lost["model"], before["model"]);
  EXPECT_EQ(lost["lineage"], before["lineage"]);

  std::filesystem::create_directories(page.session);
  EXPECT_EQ(page.state()["trouble"], "");
  for (const char* const file : {"thesis.toml", "thesis+null_bias.toml"}) {
    EXPECT_EQ(text_of(page.session / file), text_of(away / file)) << file;
  }
  const SessionFolder folder(page.session);
  EXPECT_EQ(Study(folder).state()["lineage"].size(), 2U) << "but the record is not there";
  std::filesystem::copy(away / "multisine.csv", page.session);
  ASSERT_EQ(page.post("add", {{"effect", "friction"}}).status, 200);
  EXPECT_EQ(page.state()["trial"], "thesis+null_bias+friction.toml");
}

TEST_F(StudyPage, AFitThatEndsWithTheServerIsWritten) {
  ASSERT_EQ(page.post("fit").status, 200);
  // work before which the result has to wait
  const std::string body = R"({"spans":["3:5"]})";
  std::vector<std::unique_ptr<Client>> asking;
  for (int i = 0; i < 8; ++i) {
    asking.push_back(std::make_unique<Client>(page.port));
    (void)asking.back()->send(
        "POST /api/ignore HTTP/1.1\r\nHost: " + page.host + "\r\nCookie: " + page.cookie +
        "\r\nX-Spoolwatch-Change: " + page.change +
        "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
        "\r\n\r\n" + body);
  }
  (void)asking.front()->receive(std::chrono::seconds(20), "\r\n\r\n");
  page.end();
  EXPECT_TRUE(std::filesystem::exists(page.session / "thesis-fitted.toml"));
  EXPECT_EQ(Study(SessionFolder(page.session)).state()["trial"], "thesis-fitted.toml");
}

constexpr rlim_t kFullDisk_bytes = 512;

TEST_F(StudyPage, EveryResultWaitsUntilTheDiskHasRoom) {
  const auto saved = [this] {
    return std::filesystem::exists(page.session / "thesis-fitted.toml") &&
           std::filesystem::exists(page.session / "thesis-fitted-2.toml");
  };
  {
    const tests::FileSizeLimit full(kFullDisk_bytes);
    for (int job = 0; job < 2; ++job) {
      ASSERT_EQ(page.post("fit").status, 200);
      const ordered_json state = finished();
      EXPECT_NE(state["trouble"], "");
      EXPECT_TRUE(state["result"].contains("unsaved")) << state["result"];
      EXPECT_EQ(state["trial"], "");
    }
    EXPECT_FALSE(saved());
  }
  for (int i = 0; i < 100 && !saved(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    (void)page.state();
  }
  EXPECT_TRUE(saved());
  const ordered_json state = page.state();
  EXPECT_EQ(state["trouble"], "");
  EXPECT_FALSE(state["result"].contains("unsaved"));
  EXPECT_EQ(state["trial"], "thesis-fitted-2.toml");
  EXPECT_EQ(state["lineage"].size(), 3U);
}

TEST(SessionFolder, DerivedNamesDoNotGrow) {
  EXPECT_EQ(derived_name("rig.toml", "-fitted"), "rig-fitted.toml");
  EXPECT_EQ(derived_name("rig-fitted.toml", "-fitted"), "rig-fitted.toml");
  EXPECT_EQ(derived_name("rig-fitted-12.toml", "-diagnosed"), "rig-diagnosed.toml");
  EXPECT_EQ(derived_name("rig-diagnosed.toml", "+friction"), "rig+friction.toml");
  EXPECT_EQ(derived_name("rig-2.toml", "-fitted"), "rig-2-fitted.toml");
  EXPECT_EQ(derived_name("well-fitted-rig.toml", "-fitted"), "well-fitted-rig-fitted.toml");
}

TEST_F(StudyPage, AFileThatOnlyTheReaderKnowsMayBeARecord) {
  page.put("catman.ASC", "CATMAN\r\nAnzahl Kan\xE4le: 3\r\n\r\nZeit\tWeg\r\n0\t1\r\n");
  page.put("report.html", "<!doctype html>\n");
  std::map<std::string, std::string> kinds;
  for (const FolderFile& file : SessionFolder(page.session).files()) kinds[file.name] = file.kind;
  EXPECT_EQ(kinds["catman.ASC"], "record");
  EXPECT_EQ(kinds["report.html"], "other");
  EXPECT_EQ(kinds["multisine.csv"], "record");
  EXPECT_EQ(kinds["thesis.toml"], "model");
}

TEST_F(StudyPage, ARecordIsImportedByAMappingAndByNoFile) {
  std::string text = "a;b;c\n";
  for (int k = 0; k < 300; ++k) text += fmt::format("{};{};{}\n", 0.01 * k, k % 3, 300 + k);
  page.put("bench.txt", text);
  const std::string files = page.everything();
  for (const std::string& map : {(page.session / "thesis.toml").string(), std::string("=x"),
                                 std::string("t=a[s],u=b[V],y=d[mm]")}) {
    EXPECT_EQ(page.post("import", {{"name", "bench.txt"}, {"map", map}}).status, 422) << map;
  }
  EXPECT_EQ(page.everything(), files);
  page.put("session.json", "");
  const SessionFolder folder(page.session);
  Study study(folder);
  EXPECT_EQ(study.import_record("bench.txt", "t=a[s],u=b[V],y=c[mm]"), "bench-imported.csv");
  const ordered_json state = study.state();
  EXPECT_EQ(state["record"], "bench-imported.csv");
  EXPECT_EQ(state["commands"].back(),
            "spoolwatch import bench.txt --map 't=a[s],u=b[V],y=c[mm]' -o bench-imported.csv");
  EXPECT_EQ(config::record::read_record(page.session / "bench-imported.csv").y_m[1], 0.301);
}

TEST_F(StudyPage, AShippedModelLeavesALineInTheScript) {
  ASSERT_EQ(page.post("shipped", {{"name", "velocity_servo.toml"}}).status, 200);
  EXPECT_EQ(page.state()["commands"].back(),
            "# velocity_servo.toml: the model velocity_servo.toml as it comes with spoolwatch");
}

TEST_F(StudyPage, ANameTooLongIsCutBetweenCharacters) {
  const SessionFolder folder(page.session);
  std::string name;
  for (int i = 0; i < 45; ++i) name += "ä";  // 90 bytes
  name += "-fitted.toml";
  const std::string first = folder.fresh_name(name);
  EXPECT_TRUE(is_plain_name(first)) << first;
  EXPECT_THAT(first, testing::EndsWith(".toml"));
  page.put(first, "");
  const std::string second = folder.fresh_name(name);
  EXPECT_TRUE(is_plain_name(second)) << second;
  EXPECT_THAT(second, testing::EndsWith("-2.toml"));
}

TEST_F(StudyPage, AModelWithTheLongestNameIsFitted) {
  const std::string longest = std::string(95, 'm') + ".toml";
  std::filesystem::copy_file(page.session / "thesis.toml", page.session / longest);
  ASSERT_EQ(page.post("model", {{"name", longest}}).status, 200);
  ASSERT_EQ(page.post("fit").status, 200);
  const ordered_json fitted = finished();
  EXPECT_NE(fitted["trial"], "") << fitted["result"];
  EXPECT_EQ(fitted["trial"].get<std::string>().size(), 100U);
}

TEST_F(StudyPage, ARefusedChangeLeavesSessionAndFolder) {
  const SessionFolder folder(page.session);
  Study study(folder);
  study.ignore({"3:5"});
  const std::string shown = study.state().dump();
  const std::string files = page.everything();
  EXPECT_THROW(study.take_trial("none.toml", "thesis.toml", "fitted", "spoolwatch fit"),
               config::schema::Error);
  EXPECT_EQ(study.state().dump(), shown);
  EXPECT_EQ(page.everything(), files);

  // Nothing can be saved.
  std::filesystem::remove(page.session / "session.json");
  std::filesystem::create_directory(page.session / "session.json");
  std::filesystem::create_directory(page.session / "session.json" / "full");
  const std::string unsaved = study.state().dump();
  const std::string before = page.everything();
  for (const auto& change : std::vector<std::function<void()>>{
           [&] { study.add_effect("friction"); },
           [&] { study.open_shipped("velocity_servo.toml"); }, [&] { (void)study.write_report(); },
           [&] { study.ignore({}); }, [&] { study.open_record("multisine.csv"); }}) {
    EXPECT_THROW(change(), std::exception);
    EXPECT_EQ(study.state().dump(), unsaved);
    EXPECT_EQ(page.everything(), before);
  }
}

TEST_F(StudyPage, FilesThatAreGoneLeaveTheStateReadable) {
  std::filesystem::remove(page.session / "multisine.csv");
  std::filesystem::remove(page.session / "thesis.toml");
  const ordered_json state = page.state();
  EXPECT_EQ(state["model"], "thesis.toml");
  EXPECT_FALSE(state["parameters"].empty());
  EXPECT_EQ(page.post("fit").status, 422);
}

}  // namespace
}  // namespace workbench::serve
