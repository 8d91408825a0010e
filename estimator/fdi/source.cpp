#include "estimator/fdi/source.h"

#include <cmath>
#include <cstring>

#include "config/schema/document.h"
#include "estimator/fdi/fingerprint.h"

namespace estimator::fdi {

void end_after_a_word(std::span<char> text, int wanted) noexcept {
  constexpr std::string_view kMore = "...";
  if (wanted < 0 || static_cast<std::size_t>(wanted) < text.size()) return;
  const std::size_t latest = text.size() - kMore.size() - 1;
  std::size_t end = latest;
  while (end > 0 && text[end] != ' ') --end;
  if (end == 0) end = latest;
  kMore.copy(&text[end], kMore.size());
  text[end + kMore.size()] = '\0';
}

void Outlet::reset() noexcept {
  finding = Finding{};
  reason[0] = '\0';
  fresh = false;
  for (NamedValue& v : values) v.value = v.std_error = std::numeric_limits<double>::quiet_NaN();
}

void Outlet::serialize(StateArchive& archive) {
  for (NamedValue& v : values) {
    archive.value(v.value);
    archive.value(v.std_error);
  }
  archive.value(finding.valid);
  archive.value(finding.warming_up);
  archive.value(reason);
  reason[kReason - 1] = '\0';
  finding.reason = reason;
}

bool Input::usable() const noexcept {
  return outlet_->finding.valid && !outlet_->finding.warming_up && std::isfinite(value());
}

const char* Input::why() const noexcept {
  if (outlet_->reason[0] != '\0') return outlet_->reason;
  return outlet_->finding.warming_up ? "it is warming up" : "there is no such value yet";
}

std::string SourceConfig::fingerprint() const {
  const std::unique_ptr<SourceConfig> copy = clone();
  copy->id.clear();
  return one_line(config::schema::print_toml([&](config::schema::Visitor& v) { copy->visit(v); }));
}

SourceList::SourceList(const SourceList& other) : kind(other.kind) {
  for (const auto& item : other.items) items.push_back(item->clone());
}

SourceList& SourceList::operator=(const SourceList& other) {
  SourceList copy(other);
  *this = std::move(copy);
  return *this;
}

void SourceList::visit(config::schema::Visitor& v) {
  const config::schema::Key key{kind.list, kind.what};
  items.resize(v.list(key, items.size()));
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!items[i]) items[i] = kind.make();
    v.element(key, i, [&](config::schema::Visitor& e) { items[i]->visit(e); });
  }
}

}  // namespace estimator::fdi
