#include "workbench/cli/new_stand.h"

#include <filesystem>
#include <iostream>

#include "config/record/whole_file.h"
#include "config/schema/error.h"
#include "workbench/present/shell_command.h"
#include "workbench/stand/configuration.h"
#include "workbench/stand/daemon_check.h"

namespace workbench::cli {
namespace {

namespace fs = std::filesystem;

/// The file under a name of its own until it is renamed; removed where it is not.
class Draft {
 public:
  Draft(const std::string& file, const std::string& text) : file_(file), draft_(file + ".part") {
    if (fs::exists(draft_)) {
      throw config::schema::UsageError("new stand: " + draft_.string() +
                                       " is in the way; allowed: a FILE without a FILE.part");
    }
    config::record::write_whole(draft_, text);
  }
  ~Draft() {
    std::error_code ignored;
    fs::remove(draft_, ignored);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  [[nodiscard]] const fs::path& path() const noexcept { return draft_; }
  /// `text` with the final name in the place of the draft's.
  [[nodiscard]] std::string renamed(std::string text) const {
    const std::string name = draft_.string();
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos;) {
      text.replace(at, name.size(), file_);
    }
    return text;
  }
  void keep() const { fs::rename(draft_, file_); }

 private:
  std::string file_;
  fs::path draft_;
};

std::string indented(const std::string& text) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    out += "  " + text.substr(at, end - at) + "\n";
  }
  return out;
}

/// The command line that answers without a question.
std::string command_of(const NewStandOptions& options, const stand::Answers& answers) {
  if (answers.asked_options.empty()) return options.command;
  return options.command + " " + present::shell_command(answers.asked_options);
}

}  // namespace

void make_stand(const NewStandOptions& options) {
  const stand::Answers answers = options.ask
                                     ? stand::answers_of(options.given, &std::cin, &std::cout)
                                     : stand::answers_of(options.given, nullptr, nullptr);
  stand::check_answers(answers);
  const std::string text = stand::configuration_text(
      answers, {options.name, options.output, command_of(options, answers)});
  const Draft draft(options.output, text);
  const stand::DaemonCheck check = stand::check_with_daemon(draft.path());
  if (!check.valid) {
    throw config::schema::UsageError("new stand: nothing written: " +
                                     draft.renamed(check.complaint));
  }
  draft.keep();
  std::cout << options.output << ": checked by spoolwatchd --check\n"
            << indented(draft.renamed(check.properties));
  if (!check.complaint.empty()) {
    std::cout << "not checked against the device: " << draft.renamed(check.complaint) << "\n";
  } else if (!answers.sim()) {
    std::cout << "checked against the device: it answers and has all that the file names\n";
  }
  std::cout << "still to be commissioned:\n";
  for (const std::string& step : stand::to_commission(answers, options.output)) {
    std::cout << "  - " << step << "\n";
  }
  if (answers.sim() || !answers.driven()) {
    std::cout << "next: spoolwatchd --config " << options.output << "\n";
  }
}

}  // namespace workbench::cli
