// `spoolwatch scorecard`: what each method detects, how late, under which name, and how often it
// cries wolf.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "estimator/parallel.h"
#include "workbench/cli/command.h"
#include "workbench/cli/common_options.h"
#include "workbench/cli/interrupt.h"
#include "workbench/cli/number_check.h"
#include "workbench/files/file_check.h"
#include "workbench/files/write_all.h"
#include "workbench/present/json.h"
#include "workbench/scorecard/card.h"
#include "workbench/scorecard/progress.h"
#include "workbench/scorecard/shipped.h"

namespace workbench::cli {
namespace {

using namespace scorecard;

struct ScorecardOptions {
  std::vector<std::string> methods;
  std::string plan, json, report, markdown, resume, command;
  Scope scope;
  unsigned threads = 0;
  bool details = false;
};

std::vector<Method> load_methods(const std::vector<std::string>& files) {
  std::vector<Method> methods;
  std::set<std::string> seen;
  for (const std::string& file : files.empty() ? shipped_methods() : files) {
    methods.push_back(load_method(file));
    if (!seen.insert(methods.back().name).second) {
      throw config::schema::bad_config(file + ": name",
                                       "'" + methods.back().name + "' is that of another method",
                                       "a unique name");
    }
  }
  return methods;
}

void work(const std::vector<Part>& parts, const std::vector<Method>& methods, Trials& trials,
          Store& store, unsigned threads) {
  std::vector<std::string> keys;
  keys.reserve(methods.size());
  for (const Method& method : methods) keys.push_back(digest(method.text));
  std::vector<std::pair<const Part*, std::vector<std::size_t>>> open;
  for (const Part& part : parts) {
    std::vector<std::size_t> which;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      if (part.is_for(methods[m]) && store.find(part.id, keys[m]) == nullptr) which.push_back(m);
    }
    if (!which.empty()) open.emplace_back(&part, which);
  }
  // The longest first: then both threads end together.
  std::stable_sort(open.begin(), open.end(), [](const auto& a, const auto& b) {
    return a.first->work_s * static_cast<double>(a.second.size()) >
           b.first->work_s * static_cast<double>(b.second.size());
  });
  double all_s = 0.0;
  for (const auto& [part, which] : open) all_s += part->work_s * static_cast<double>(which.size());
  ScorecardProgress progress(std::cerr, isatty(STDERR_FILENO) == 1, open.size(), all_s);
  std::mutex mutex;
  try {
    estimator::in_parallel(open.size(), threads, [&](std::size_t i) {
      if (Interrupt::requested()) return;
      const auto& [part, which] = open[i];
      std::vector<nlohmann::json> results = trials.run(*part, which, Interrupt::requested);
      const std::lock_guard lock(mutex);
      for (std::size_t k = 0; k < results.size(); ++k) {
        store.put(part->id, keys[which[k]], std::move(results[k]));
      }
      if (!results.empty()) {
        progress.add(part->work_s * static_cast<double>(which.size()), part->id);
      }
    });
  } catch (...) {
    store.save();
    throw;
  }
  progress.end();
  store.save();
}

int run(const ScorecardOptions& o) {
  std::vector<files::OutputFile> outputs{{"--json", o.json},
                                         {"--report", o.report},
                                         {"--markdown", o.markdown},
                                         {"--resume", o.resume}};
  files::check_outputs(outputs, {o.plan.empty() ? "/" : o.plan, o.methods});
  const Bench bench = load_bench(o.plan);
  const std::vector<Method> methods = load_methods(o.methods);
  const std::vector<Part> parts = parts_of(bench, o.scope);
  Store store(o.resume, digest(bench.text + std::to_string(o.scope.seeds) + "/" +
                               std::to_string(o.scope.seed)));
  Trials trials(bench, methods, o.scope);
  const auto begin = std::chrono::steady_clock::now();
  int stopped = 0;
  {
    const Interrupt interrupt;
    const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
    work(parts, methods, trials, store, o.threads > 0 ? o.threads : processors);
    stopped = Interrupt::exit_code();
  }
  Card card = make_card(bench, methods, o.scope, parts, store, trials);
  card.command = o.command;
  card.runtime_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  files::write_all({[&] {
                      if (!o.report.empty()) write_report(to_report(card), o.report);
                    },
                    [&] {
                      if (!o.markdown.empty())
                        config::record::write_whole(o.markdown, to_markdown(card));
                    },
                    [&] {
                      if (!present::write_json(to_json(card), o.json))
                        std::cout << to_text(card, o.details);
                    }});
  return stopped;
}

}  // namespace

void add_scorecard(CLI::App& command, int& exit_code) {
  auto o = std::make_shared<ScorecardOptions>();
  command.add_option("METHOD", o->methods,
                     "files of methods, or names of shipped ones; default: all that are shipped");
  command.add_flag("--full", o->scope.full,
                   "72 h without a fault, enough for one false alarm in 24 h");
  command.add_option("--seeds", o->scope.seeds, "trials of each fault, direction, size and motion")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      .add_option("--seed", o->scope.seed,
                  "seed of noise and phases; the same seed gives the same figures")
      ->check(number_within(0.0, 1e18))
      ->capture_default_str();
  command.add_option("--hours", o->scope.hours, "h without a fault; default: the plan's")
      ->check(number_within(0.0, 1e5));
  command.add_option("--motion", o->scope.motions, "only these of the plan")
      ->allow_extra_args(false);
  command.add_option("--fault", o->scope.faults, "only these of the plan")->allow_extra_args(false);
  command.add_option("--plan", o->plan, "plan (TOML); default: the shipped one")
      ->check(CLI::ExistingFile);
  command.add_option("--resume", o->resume,
                     "file of finished parts, from which a later run continues");
  command.add_option("--threads", o->threads, "number of threads; default: one per processor")
      ->check(CLI::Range(1, 1024));
  command.add_flag("--details", o->details, "print the first names of alarms as well");
  add_json(command, o->json);
  add_report(command, o->report);
  command.add_option("--markdown", o->markdown, "file for the tables (Markdown)");
  command.callback([o, &exit_code, &command] {
    o->command = command_line("scorecard", command);
    exit_code = run(*o);
  });
}

}  // namespace workbench::cli
