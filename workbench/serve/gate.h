// Who may talk to the page: the browser in which its address was opened, and no other site, user or
// name that points here.
//
// The address carries a random token as its fragment, which browsers never send. The page's program
// exchanges it by POST for a cookie (HttpOnly, SameSite=Strict, named after the port) and for a
// second secret that every change must carry in a header. Whatever the cookie says, Host must be a
// loopback name with this port, Origin and Sec-Fetch-Site must be this page's or absent.
#pragma once

#include <string>
#include <string_view>

#include "workbench/serve/http_server.h"

namespace workbench::serve {

/// 256 random bits as 64 hexadecimal digits. Throws config::schema::RunError.
[[nodiscard]] std::string random_secret();

/// Takes the same time wherever the texts differ.
[[nodiscard]] bool same_secret(std::string_view a, std::string_view b) noexcept;

class Gate {
 public:
  /// `port` 0: a Unix socket, whose client chooses the port of its tunnel.
  explicit Gate(unsigned short port);

  struct Verdict {
    int status = 200;  ///< 200: may pass
    std::string why{};
  };
  /// Is the request one of this page's? Of every request.
  [[nodiscard]] Verdict from_here(const HttpHead& head) const;
  /// Has it the cookie; for a change (`writes`) the header too, POST, and one of the types.
  [[nodiscard]] Verdict allowed(const HttpHead& head, bool writes) const;

  /// The value of Set-Cookie for a right token; "" otherwise.
  [[nodiscard]] std::string cookie_for(std::string_view token) const;

  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] const std::string& change_secret() const { return change_; }

 private:
  [[nodiscard]] bool is_our_host(std::string_view host) const;

  unsigned short port_;
  std::string token_, cookie_, change_, cookie_name_;
};

}  // namespace workbench::serve
