#include "workbench/serve/gate.h"

#include <sys/random.h>

#include <algorithm>
#include <array>

#include "config/schema/error.h"

namespace workbench::serve {
namespace {

constexpr std::string_view kChangeHeader = "x-spoolwatch-change";

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 && text.front() != '0' &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// The value of a cookie, "" where it is absent or given twice.
std::string_view cookie_named(std::string_view cookies, std::string_view name) {
  std::string_view found;
  int count = 0;
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view one = cookies.substr(0, end);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
    while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
    if (one.size() > name.size() && one.substr(0, name.size()) == name && one[name.size()] == '=') {
      found = one.substr(name.size() + 1);
      ++count;
    }
  }
  return count == 1 ? found : std::string_view{};
}

}  // namespace

std::string random_secret() {
  std::array<unsigned char, 32> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw config::schema::RunError("the system gives no random numbers");
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

bool same_secret(std::string_view a, std::string_view b) noexcept {
  unsigned differs = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < b.size(); ++i) {
    differs |= static_cast<unsigned>(static_cast<unsigned char>(i < a.size() ? a[i] : '\0')) ^
               static_cast<unsigned>(static_cast<unsigned char>(b[i]));
  }
  return differs == 0;
}

Gate::Gate(unsigned short port)
    : port_(port),
      token_(random_secret()),
      cookie_(random_secret()),
      change_(random_secret()),
      cookie_name_("spoolwatch_" +
                   (port != 0 ? std::to_string(port) : random_secret().substr(0, 16))) {}

bool Gate::is_our_host(std::string_view host) const {
  for (const std::string_view name : {"127.0.0.1", "localhost"}) {
    if (host.substr(0, name.size()) != name) continue;
    const std::string_view rest = host.substr(name.size());
    if (rest.empty()) return port_ == 0 || port_ == 80;
    if (rest.front() != ':' || !is_port(rest.substr(1))) continue;
    if (port_ == 0 || rest.substr(1) == std::to_string(port_)) return true;
  }
  return false;
}

Gate::Verdict Gate::from_here(const HttpHead& head) const {
  if (head.path.empty() || head.path.front() != '/') return {400, "the target is no path"};
  if (head.count("host") != 1) return {400, "one Host is needed"};
  const std::string_view host = head.field("host");
  if (!is_our_host(host)) return {421, "this is not the address of the page"};
  if (head.count("origin") > 1 || head.count("sec-fetch-site") > 1) return {400, "given twice"};
  if (head.count("upgrade") > 0) return {400, "there is nothing to upgrade to"};
  if (head.count("origin") == 1 && head.field("origin") != "http://" + std::string(host)) {
    return {403, "another site's page may not ask"};
  }
  const std::string_view site = head.field("sec-fetch-site");
  if (!site.empty() && site != "same-origin" && site != "none") {
    return {403, "another site's page may not ask"};
  }
  return {};
}

Gate::Verdict Gate::allowed(const HttpHead& head, bool writes) const {
  if (head.count("cookie") != 1 ||
      !same_secret(cookie_named(head.field("cookie"), cookie_name_), cookie_)) {
    return {401, "open the address that spoolwatch serve has printed"};
  }
  if (!writes) return {};
  if (head.count("origin") == 0 && head.field("sec-fetch-site") != "same-origin" &&
      head.count("sec-fetch-site") != 0) {
    return {403, "another site's page may not ask"};
  }
  if (head.count(kChangeHeader) != 1 || !same_secret(head.field(kChangeHeader), change_)) {
    return {403, "the page is an old one: load it again"};
  }
  const std::string_view type = head.field("content-type");
  if (type != "application/json" && type != "application/octet-stream") {
    return {415, "application/json is expected"};
  }
  return {};
}

std::string Gate::cookie_for(std::string_view token) const {
  if (!same_secret(token, token_)) return {};
  return cookie_name_ + "=" + cookie_ + "; HttpOnly; SameSite=Strict; Path=/";
}

}  // namespace workbench::serve
