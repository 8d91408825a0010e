// Other sites, other users, other names and other paths: each is refused, and nothing changes.
#include <gmock/gmock.h>

#include <algorithm>
#include <atomic>

#include "tests/workbench/serve/loopback.h"
#include "workbench/serve/gate.h"
#include "workbench/serve/session_folder.h"

namespace workbench::serve {
namespace {

using nlohmann::ordered_json;
using testing::AnyOf;
using testing::Eq;
using testing::HasSubstr;
using testing::Not;

const std::string kRecord = [] {
  std::string text = "t_s,u_V,y_m\n";
  for (int k = 0; k < 800; ++k) {
    const double t = 0.005 * k;
    text += std::to_string(t) + "," + std::to_string(std::sin(5.0 * t)) + "," +
            std::to_string(0.3 + 0.01 * std::sin(5.0 * t)) + "\n";
  }
  return text;
}();

/// Files in the folder that no name leads to.
std::size_t hidden_files(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::count_if(begin(files), end(files), [](const auto& entry) {
    return entry.path().filename().string().front() == '.';
  }));
}

class Attack : public testing::Test {
 protected:
  void SetUp() override {
    page.log_in();
    page.put("record.csv", kRecord);
    ASSERT_EQ(page.post("shipped", {{"name", "thesis.toml"}}).status, 200);
    before_ = page.everything();
  }
  void TearDown() override { EXPECT_EQ(page.everything(), before_); }
  /// A request that would change something, with other fields than the page's own.
  Answer change_with(const std::vector<std::pair<std::string, std::string>>& fields) const {
    return page.ask("POST", "/api/record", R"({"name":"record.csv"})", fields);
  }
  ServedFolder page;
  std::string before_;
};

TEST_F(Attack, OfAnotherHostName) {
  const std::string port = std::to_string(page.port);
  for (const std::string& host :
       {std::string("evil.example"), "evil.example:" + port, "127.0.0.1.evil:" + port,
        std::string("localhost:1"), std::string("127.0.0.1"), "0.0.0.0:" + port,
        "localhost.:" + port, "[::1]:" + port, "[::ffff:127.0.0.1]:" + port, "127.1:" + port,
        "2130706433:" + port, "localhost:" + port + ":" + port, "localhost:0" + port,
        "user@localhost:" + port, "localhost:" + port + ".evil"}) {
    EXPECT_EQ(change_with({{"Host", host}}).status, 421) << host;
    EXPECT_EQ(page.ask("GET", "/api/state", "", {{"Host", host}}).status, 421) << host;
    EXPECT_EQ(page.ask("GET", "/", "", {{"Host", host}}).status, 421) << host;
    EXPECT_EQ(page.ask("GET", "/api/events", "", {{"Host", host}}).status, 421) << host;
  }
  EXPECT_EQ(change_with({{"Host", ""}}).status, 400);
  EXPECT_EQ(
      page.raw("GET / HTTP/1.1\r\nHost: " + page.host + "\r\nHost: evil.example\r\n\r\n").status,
      400);
  EXPECT_EQ(page.raw("GET / HTTP/1.1\r\n\r\n").status, 400);
}

TEST_F(Attack, OfAnotherOrigin) {
  const std::string ours = "http://" + page.host;
  for (const std::string& origin :
       {std::string("http://evil.example"), std::string("http://127.0.0.1:1"), std::string("null"),
        ours + ".evil", "https://" + page.host, "HTTP://" + page.host, ours + "/",
        "http://evil.example/" + ours, "http://localhost:" + std::to_string(page.port)}) {
    EXPECT_EQ(change_with({{"Origin", origin}}).status, 403) << origin;
    EXPECT_EQ(page.ask("GET", "/api/state", "", {{"Origin", origin}}).status, 403) << origin;
  }
  for (const char* site : {"cross-site", "same-site"}) {
    EXPECT_EQ(change_with({{"Sec-Fetch-Site", site}}).status, 403) << site;
    EXPECT_EQ(page.ask("GET", "/api/events", "", {{"Sec-Fetch-Site", site}}).status, 403) << site;
  }
  EXPECT_EQ(change_with({{"Sec-Fetch-Site", "none"}}).status, 403);
}

TEST_F(Attack, OfAFormOfAnotherPage) {
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data",
                           "application/json; charset=x", ""}) {
    EXPECT_EQ(change_with({{"Content-Type", type}}).status, 415) << type;
  }
  EXPECT_EQ(change_with({{"Content-Type", "application/octet-stream"}}).status, 415);
}

TEST_F(Attack, WithoutTheSecretsOrWithOthers) {
  EXPECT_EQ(change_with({{"Cookie", ""}}).status, 401);
  EXPECT_EQ(change_with({{"Cookie", page.cookie.substr(0, page.cookie.size() - 1)}}).status, 401);
  EXPECT_EQ(change_with({{"Cookie", page.cookie + "; " + page.cookie}}).status, 401);
  EXPECT_EQ(
      change_with({{"Cookie", "spoolwatch_" + std::to_string(page.port) + "=" + page.token()}})
          .status,
      401);
  EXPECT_EQ(change_with({{"X-Spoolwatch-Change", ""}}).status, 403);
  EXPECT_EQ(change_with({{"X-Spoolwatch-Change", page.token()}}).status, 403);
  EXPECT_EQ(page.ask("GET", "/api/state?token=" + page.token(), "", {{"Cookie", ""}}).status, 401);
  EXPECT_EQ(page.ask("GET", "/files/record.csv", "", {{"Cookie", ""}}).status, 401);
  for (const std::string& token : {std::string(), page.token().substr(1), std::string(64, '0')}) {
    const Answer answer = page.ask("POST", "/api/login", ordered_json{{"token", token}}.dump());
    EXPECT_EQ(answer.status, 401);
    EXPECT_THAT(answer.head, Not(HasSubstr("Set-Cookie")));
  }
  EXPECT_EQ(page.ask("POST", "/api/login", "[]").status, 401);
}

TEST_F(Attack, OfTheCookieByAnotherStandOnThisMachine) {
  const ServedFolder other({}, "served_other");
  EXPECT_NE(page.cookie.substr(0, page.cookie.find('=')),
            "spoolwatch_" + std::to_string(other.port));
  EXPECT_EQ(other.ask("GET", "/api/state", "", {{"Cookie", page.cookie}}).status, 401);
  const Answer in = page.ask("POST", "/api/login", R"({"token":")" + page.token() + "\"}");
  EXPECT_THAT(in.head, HasSubstr("; HttpOnly; SameSite=Strict; Path=/"));
}

TEST_F(Attack, OnTheTokenInErrors) {
  for (const Answer& answer :
       {page.ask("GET", "/" + page.token()), page.ask("GET", "/files/" + page.token()),
        page.ask("POST", "/api/" + page.token(), "{}"),
        page.ask("POST", "/api/login", page.token())}) {
    EXPECT_GE(answer.status, 400);
    EXPECT_THAT(answer.head + answer.body, Not(HasSubstr(page.token())));
  }
}

TEST_F(Attack, ByPathsOutOfTheFolder) {
  std::ofstream(page.folder / "secret.csv") << kRecord;
  std::filesystem::create_symlink(page.folder / "secret.csv", page.session / "link.csv");
  before_ = page.everything();
  for (const std::string& path :
       {std::string("../secret.csv"), std::string("%2e%2e/secret.csv"),
        std::string("%2e%2e%2fsecret.csv"), std::string("..%5csecret.csv"),
        std::string("%252e%252e/secret.csv"), std::string("link.csv"),
        (page.folder / "secret.csv").string(), std::string("record.csv%00.csv"), std::string("."),
        std::string("%"), std::string("%zz"), std::string(300, 'a'), std::string(".upload-x"),
        std::string("%ff%fe.csv")}) {
    EXPECT_THAT(page.ask("GET", "/files/" + path).status, AnyOf(Eq(404), Eq(422), Eq(400))) << path;
  }
  for (const std::string& name :
       {std::string("../secret.csv"), std::string("link.csv"),
        (page.folder / "secret.csv").string(), std::string("record.csv\0.csv", 15),
        std::string(300, 'a'), std::string("-o"), std::string()}) {
    EXPECT_EQ(page.post("record", {{"name", name}}).status, 422) << name;
    EXPECT_EQ(page.post("model", {{"name", name}}).status, 422) << name;
  }
  for (const char* name : {"..%2fx.csv", "%2ftmp%2fx.csv", "x%0a.csv", ".hidden", "", "a%00b"}) {
    EXPECT_EQ(page.ask("POST", std::string("/api/upload?name=") + name, kRecord,
                       {{"Content-Type", "application/octet-stream"}})
                  .status,
              422)
        << name;
  }
}

TEST_F(Attack, OfFourPagesThatMoveASliderThirtyTimesASecond) {
  ASSERT_EQ(page.post("record", {{"name", "record.csv"}}).status, 200);
  before_ = page.everything();
  std::atomic<int> answered{0};
  std::atomic<int> superseded{0};
  std::vector<std::thread> pages;
  for (int p = 0; p < 4; ++p) {
    pages.emplace_back([&, p] {
      auto next = std::chrono::steady_clock::now();
      for (int i = 0; i < 60; ++i) {
        const double damping = 900.0 + p + i;
        const Answer answer =
            page.post("preview", {{"values", {{"damping_N_s_per_m", damping}}}, {"rows", 2000}});
        EXPECT_EQ(answer.status, 200);
        (answer.body.find("superseded") == std::string::npos ? answered : superseded) += 1;
        next += std::chrono::milliseconds(33);
        std::this_thread::sleep_until(next);
      }
    });
  }
  for (int i = 0; i < 10; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(page.ask("GET", "/").status, 200);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
  }
  for (std::thread& one : pages) one.join();
  EXPECT_EQ(answered + superseded, 240);
  EXPECT_GT(answered, 0);
}

TEST_F(Attack, ByFilesThatAreNoRecords) {
  const auto upload = [&](const std::string& name, const std::string& text) {
    return page.ask("POST", "/api/upload?name=" + name, text,
                    {{"Content-Type", "application/octet-stream"}});
  };
  std::string wide = "t_s,u_V,y_m";
  for (int i = 0; i < 100'000; ++i) wide += ",c";
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"empty.csv", ""},
                                   {"rows.csv", "t_s,u_V,y_m\n"},
                                   {"nan.csv", "t_s,u_V,y_m\n0,nan,nan\n0.005,nan,nan\n"},
                                   {"wide.csv", wide + "\n"},
                                   {"noise.mat", std::string(1000, '\x7f')},
                                   {"bad.toml", "plant = ["},
                                   {"page.csv", "<script>alert(1)</script>"}}) {
    const Answer answer = upload(name, text);
    EXPECT_EQ(answer.status, 422) << name;
    EXPECT_THAT(answer.body, HasSubstr("error")) << name;
  }
}

TEST_F(Attack, ByRequestsOfNonsense) {
  for (const char* path :
       {"record", "model", "shipped", "add", "ignore", "preview", "fit", "diagnose"}) {
    for (const char* body :
         {"", "[]", "{", "null", R"({"name":1,"spans":1,"values":[],"only":[1]})"}) {
      EXPECT_THAT(page.ask("POST", std::string("/api/") + path, body).status,
                  AnyOf(Eq(400), Eq(422)))
          << path << body;
    }
  }
  EXPECT_EQ(page.post("ignore", {{"spans", {"1:2", "x"}}}).status, 422)
      << "spans are checked although no record is open";
  EXPECT_EQ(page.post("add", {{"effect", "<script>"}}).status, 422);
  EXPECT_EQ(page.post("nothing").status, 404);
}

TEST_F(Attack, WithOrdersThatThisPageMayNotGive) {
  EXPECT_EQ(page.post("alarm", {{"order", "ack"}, {"alarm", "a.b"}}).status, 403);
  ServeOptions options;
  options.allow_orders = true;
  ServedFolder ordering(options, "served_orders");
  ordering.log_in();
  for (const char* word :
       {"arm", "start", "stop", "disarm", "reset", "hold", "reference", "reload"}) {
    EXPECT_EQ(ordering.post("alarm", {{"order", word}, {"alarm", "a.b"}}).status, 403) << word;
  }
  const Answer no_daemon = ordering.post("alarm", {{"order", "ack"}, {"alarm", "a.b"}});
  EXPECT_EQ(no_daemon.status, 422);
  EXPECT_THAT(no_daemon.body, HasSubstr("no daemon is there"));
}

TEST(Gate, SecretsAreLongAndNeverTheSame) {
  EXPECT_EQ(random_secret().size(), 64U);
  EXPECT_NE(random_secret(), random_secret());
  EXPECT_TRUE(same_secret("abc", "abc"));
  for (const char* other : {"", "ab", "abd", "abcd", "Abc"})
    EXPECT_FALSE(same_secret(other, "abc"));
}

TEST(SessionFolder, TakesPlainNamesAlone) {
  for (const char* name : {"a.csv", "<script>.csv", "=cmd.csv", "M\xC3\xBCller 1.csv", "a..b"}) {
    EXPECT_TRUE(is_plain_name(name)) << name;
  }
  for (const std::string& name :
       {std::string(), std::string(".."), std::string("a/b"), std::string("-o"),
        std::string("a\nb"), std::string("\xFF.csv"), std::string("\xC0\xAF"),
        std::string(101, 'a'), std::string("a\\b")}) {
    EXPECT_FALSE(is_plain_name(name)) << name;
  }
}

TEST(Upload, LeavesNothingWhereItIsRefused) {
  ServedFolder page({}, "served_upload");
  page.log_in();
  const auto upload = [&](const std::string& name, const std::string& text) {
    return page
        .ask("POST", "/api/upload?name=" + name, text,
             {{"Content-Type", "application/octet-stream"}})
        .status;
  };
  EXPECT_EQ(upload("bad.csv", "t_s,u_V,y_m\n0,1,x\n"), 422);
  EXPECT_EQ(upload("bad.toml", "nothing = 1\n"), 422);
  // A second file of this name has no room for a number.
  const std::string longest = "r." + std::string(98, 'x');
  page.put(longest, "");
  EXPECT_EQ(upload(longest, kRecord), 422);
  EXPECT_EQ(hidden_files(page.session), 0U);
  EXPECT_EQ(upload("good.csv", kRecord), 200);
  EXPECT_EQ(hidden_files(page.session), 0U);
  EXPECT_TRUE(std::filesystem::exists(page.session / "good.csv"));
}

}  // namespace
}  // namespace workbench::serve
