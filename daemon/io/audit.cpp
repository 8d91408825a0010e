#include "daemon/io/audit.h"

#include <fmt/chrono.h>
#include <pwd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <nlohmann/json.hpp>

namespace monitor::io {
namespace {

constexpr std::size_t kLongestRequest = 512;
/// Lines of rejections of one user: a person's mistakes, not a flood.
constexpr double kMostRejections = 20.0;
constexpr double kRejectionsPerSecond = 0.2;
constexpr std::size_t kMostUsers = 1000;

}  // namespace

std::string utc_text(std::int64_t utc_us) {
  const std::time_t seconds = utc_us / 1'000'000;
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", utc, utc_us / 1000 % 1000);
}

std::string user_name(unsigned uid) {
  std::array<char, 4096> memory{};
  passwd entry{};
  passwd* found = nullptr;
  if (getpwuid_r(uid, &entry, memory.data(), memory.size(), &found) == 0 && found != nullptr) {
    return entry.pw_name;
  }
  return std::to_string(uid);
}

std::string print_audit(const AuditEntry& entry) {
  nlohmann::ordered_json line;
  line["utc"] = utc_text(entry.utc_us);
  line["uid"] = entry.uid;
  line["who"] = entry.who;
  line["what"] = entry.what.substr(0, kLongestRequest);
  line["done"] = entry.reject_reason.empty();
  if (!entry.reject_reason.empty()) line["reason"] = entry.reject_reason;
  if (entry.not_listed > 0) line["not_listed"] = entry.not_listed;
  return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

Audit::Audit(const std::filesystem::path& folder, std::int64_t file_bytes, BackgroundWriter& writer)
    : acts_(std::make_shared<CappedFile>(folder / "audit.log", file_bytes)),
      refused_(std::make_shared<CappedFile>(folder / "refused.log", file_bytes)),
      writer_(writer) {}

Audit::~Audit() {
  for (const auto& [uid, past] : rejections_) {
    if (past.not_listed == 0) continue;
    write({past.utc_us, uid, past.who, "", "refused like those before", past.may_act,
           past.not_listed});
  }
}

bool Audit::lists(const AuditEntry& entry) {
  if (rejections_.size() >= kMostUsers && !rejections_.contains(entry.uid)) rejections_.clear();
  Rejections& past =
      rejections_.try_emplace(entry.uid, Rejections{kMostRejections, entry.utc_us, 0, {}, true})
          .first->second;
  const double passed_s = static_cast<double>(entry.utc_us - past.utc_us) * 1e-6;
  past.utc_us = entry.utc_us;
  past.who = entry.who;
  past.may_act = entry.may_act;
  past.allowed =
      std::min(kMostRejections, past.allowed + std::max(0.0, passed_s) * kRejectionsPerSecond);
  if (past.allowed < 1.0) {
    ++past.not_listed;
    return false;
  }
  past.allowed -= 1.0;
  return true;
}

void Audit::note(AuditEntry entry) {
  if (!entry.reject_reason.empty() && !lists(entry)) return;
  if (const auto past = rejections_.find(entry.uid); past != rejections_.end()) {
    entry.not_listed = std::exchange(past->second.not_listed, 0);
  }
  write(entry);
}

void Audit::write(const AuditEntry& entry) {
  const std::shared_ptr<CappedFile>& file = entry.may_act ? acts_ : refused_;
  if (!writer_.post([file, line = print_audit(entry)] { file->append(line); })) file->lose();
}

}  // namespace monitor::io
