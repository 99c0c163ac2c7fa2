#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gateway {

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// The value of a parameter behind the `?` of an address; nothing if it is not there.
std::optional<std::string_view> Parameter(std::string_view target, std::string_view name);

/// Who may come to a server: programs that show its token, and pages only of sites that are named.
/// Thread: constant after construction.
class Visitors {
 public:
  struct Refusal {
    boost::beast::http::status status;
    std::string what;
  };
  Visitors(std::string token, std::vector<std::string> origins)
      : token_(std::move(token)), origins_(std::move(origins)) {}

  /// Another site's page may come only where it was named; and a site whose name leads to our
  /// address (DNS rebinding) sends its own name as the host. `host` is our own, "127.0.0.1:8090".
  std::optional<Refusal> CheckSite(const HttpRequest& request, std::string_view host) const;
  /// By a header, or, for browsers' WebSockets, which cannot have one, in the address.
  bool HasToken(const HttpRequest& request) const;
  /// The site of the request's page, where it was named; "" otherwise.
  std::string NamedOrigin(const HttpRequest& request) const;

 private:
  bool IsNamed(const std::string& site) const;

  const std::string token_;
  const std::vector<std::string> origins_;
};

}  // namespace gateway
