// spoolwatch-soak: the long run in virtual time, and the books of a run under load (scripts/soak).
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "config/record/log_reader.h"
#include "tests/soak/books.h"
#include "tests/soak/month.h"
#include "tests/soak/quiet.h"
#include "tests/soak/week.h"

namespace {

int reconcile(const std::filesystem::path& folder, const std::string& report, bool complete) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  soak::Books books;
  for (const auto& file : files) {
    config::record::LogReader reader(file.string());
    while (const config::record::LogEvent* event = reader.next()) {
      books.take(event->channel, event->data.data(), event->size());
    }
    if (!reader.at_end()) {
      std::cerr << file.string() << ": ends with half an event\n";
      return 1;
    }
  }
  std::ostringstream text;
  text << std::ifstream(report).rdbuf();
  const auto closing = soak::closing_report(text.str());
  if (!closing) {
    std::cerr << report << ": no closing report of spoolwatchd\n" << text.str();
    return 1;
  }
  const bool good = soak::print(books.balance(*closing, complete), std::cout);
  std::cout << (good ? "  it adds up\n" : "  IT DOES NOT ADD UP\n");
  return good ? 0 : 1;
}

int be_quiet(const soak::QuietOptions& options) {
  const soak::QuietResult result = soak::run_quiet(options);
  std::cout << options.hours << " h, " << result.samples << " samples, " << result.estimates
            << " estimates, " << result.valid << " of them valid, " << result.alarms.size()
            << " alarms\n";
  for (const std::string& alarm : result.alarms) std::cout << "  " << alarm << '\n';
  if (result.exit_code != 0) std::cerr << result.err;
  return result.exit_code == 0 && result.alarms.empty() && result.valid > 0 ? 0 : 1;
}

int run(int argc, char** argv) {
  CLI::App app("Long runs of spoolwatchd, checked.", "spoolwatch-soak");
  app.require_subcommand(1);

  soak::WeekOptions week;
  week.config = SPOOLWATCH_SOURCE_DIR "/config/demo.toml";
  auto* run = app.add_subcommand("week", "virtual time with random faults");
  run->add_option("--hours", week.hours, "of simulated time")->check(CLI::Range(0.2, 100000.0));
  run->add_option("--seed", week.seed, "of faults and noise");
  run->add_flag("--record", week.record, "with the recorder, in a few small files");
  run->add_option("--set", week.more, "for the daemon: table.key=value")->allow_extra_args(false);

  soak::MonthOptions month;
  month.config = SPOOLWATCH_SOURCE_DIR "/config/demo.toml";
  auto* uneven = app.add_subcommand("month", "virtual time; devices, clocks, disk and peer fail");
  uneven->add_option("--hours", month.hours, "of simulated time")->check(CLI::Range(0.2, 100000.0));
  uneven->add_option("--seed", month.seed, "of faults and noise");
  uneven->add_option("--set", month.more, "for the daemon: table.key=value")
      ->allow_extra_args(false);

  soak::QuietOptions quiet;
  quiet.config = SPOOLWATCH_SOURCE_DIR "/config/thesis_case3_named.toml";
  auto* stay = app.add_subcommand("quiet", "virtual time without a fault: no alarm may come");
  stay->add_option("--hours", quiet.hours, "of simulated time")->check(CLI::Range(0.01, 100000.0));
  stay->add_option("--seed", quiet.seed, "of the noise");

  std::string folder;
  std::string report;
  bool complete = false;
  auto* add_up = app.add_subcommand("reconcile", "what was counted against what the log holds");
  add_up->add_option("--log", folder, "folder of the recorder")->required();
  add_up->add_option("--report", report, "what the daemon wrote to standard error")->required();
  add_up->add_flag("--complete", complete, "nothing may be missing, counted or not");
  CLI11_PARSE(app, argc, argv);

  if (add_up->parsed()) return reconcile(folder, report, complete);
  if (stay->parsed()) return be_quiet(quiet);
  if (uneven->parsed()) return soak::run_month(month, std::cout).problem_count == 0 ? 0 : 1;
  std::vector<std::string> words;
  for (const std::string& set : week.more) words.insert(words.end(), {"--set", set});
  week.more = words;
  return soak::run_week(week, std::cout).problem_count == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "spoolwatch-soak: " << e.what() << '\n';
    return 1;
  }
}
