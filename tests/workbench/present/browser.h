// A page as a headless Chromium shows it, and what it asked of the network meanwhile.
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace workbench::present {

struct Visit {
  int status = -1;
  std::string document;            ///< the elements after every script has run
  std::set<std::string> requests;  ///< addresses that the page itself asked for
};

inline bool have_browser() { return std::system("command -v chromium >/dev/null 2>&1") == 0; }

inline std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

inline Visit visit(const std::string& page) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("spoolwatch_browser_" + std::to_string(getpid()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  std::ofstream(folder / "page.html", std::ios::binary) << page;
  const std::string at = folder.string();
  // No name resolves, so nothing reaches a network; what was asked for stands in the log.
  const std::string command =
      "HOME=" + at +
      " timeout -k 5 60 chromium --headless=new --no-sandbox --disable-gpu"
      " --disable-dev-shm-usage --no-first-run --disable-background-networking"
      " --disable-component-update --disable-sync --window-size=1366,900"
      " '--host-resolver-rules=MAP * ~NOTFOUND' --user-data-dir=" +
      at +
      "/profile"
      " --log-net-log=" +
      at + "/net.json --virtual-time-budget=10000 --dump-dom file://" + at + "/page.html >" + at +
      "/document 2>" + at + "/errors";
  Visit visit;
  visit.status = std::system(command.c_str());
  visit.document = read_text(folder / "document");
  // The browser's own requests (its update check, say) have "not an origin".
  static const std::regex request(R"re("initiator":"(?!not an origin")[^\n]*?"url":"([^"]+)")re");
  std::istringstream log(read_text(folder / "net.json"));
  for (std::string line; std::getline(log, line);) {
    std::smatch match;
    if (line.size() < 20'000 && std::regex_search(line, match, request)) {
      visit.requests.insert(match[1]);
    }
  }
  fs::remove_all(folder);
  return visit;
}

}  // namespace workbench::present
