#pragma once

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vm {

using WebRequest = boost::beast::http::request<boost::beast::http::string_body>;

std::string_view WebHeader(const WebRequest& request, boost::beast::http::field name);
/// The value of a parameter behind the `?` of an address; nothing if it is not there.
std::optional<std::string_view> WebParameter(std::string_view target, std::string_view name);
/// Whether the part of `text` behind `name` (whose case does not count, as of an authorization's
/// scheme) is the token; takes as long for a wrong one as for a right one.
bool ShowsToken(std::string_view text, std::string_view name, const std::string& token);

/// Who may come to a web server: programs that show its token, and pages only of sites that are
/// named. Case of sites and hosts does not count. Thread: constant after construction.
class WebVisitors {
 public:
  struct Refusal {
    boost::beast::http::status status;
    std::string what;
  };
  WebVisitors(std::string token, std::vector<std::string> origins);

  /// Another site's page may come only where it was named; and a site whose name leads to our
  /// address (DNS rebinding) sends its own name as the host. `host` is our own, "127.0.0.1:8090".
  std::optional<Refusal> CheckSite(const WebRequest& request, std::string_view host) const;
  /// By a header, or, for browsers' WebSockets, which cannot have one, in the address.
  bool HasToken(const WebRequest& request) const;
  /// The site of the request's page, where it was named; "" otherwise.
  std::string NamedOrigin(const WebRequest& request) const;
  const std::string& token() const { return token_; }

 private:
  bool IsNamed(const std::string& site) const;

  const std::string token_;
  std::vector<std::string> origins_;  // in small letters
};

}  // namespace vm
