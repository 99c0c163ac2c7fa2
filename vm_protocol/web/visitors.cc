#include "vm_protocol/web/visitors.h"

#include <algorithm>

#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/runtime/credentials.h"

namespace vm {
namespace {

namespace http = boost::beast::http;
using std::string_view;

bool IsOwn(string_view site, string_view host) {
  return site == "http://" + std::string(host) ||
         site == "http://localhost" + std::string(host.substr(host.rfind(':')));
}

}  // namespace

string_view WebHeader(const WebRequest& request, http::field name) {
  const auto text = request[name];
  return {text.data(), text.size()};
}

std::optional<string_view> WebParameter(string_view target, string_view name) {
  string_view rest = target.substr(std::min(target.find('?'), target.size()));
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const string_view part = rest.substr(0, rest.find('&'));
    rest.remove_prefix(part.size());
    if (part.starts_with(name) && part.substr(name.size()).starts_with('=')) {
      return part.substr(name.size() + 1);
    }
  }
  return {};
}

bool ShowsToken(string_view text, string_view name, const std::string& token) {
  return LowerCase(text.substr(0, name.size())) == LowerCase(name) &&
         SameProof(std::string(text.substr(name.size())), token);
}

WebVisitors::WebVisitors(std::string token, std::vector<std::string> origins)
    : token_(std::move(token)), origins_(std::move(origins)) {
  for (std::string& origin : origins_) origin = LowerCase(origin);
}

bool WebVisitors::IsNamed(const std::string& site) const {
  return std::ranges::find(origins_, site) != origins_.end();
}

std::optional<WebVisitors::Refusal> WebVisitors::CheckSite(const WebRequest& request,
                                                           string_view host) const {
  const std::string origin = LowerCase(WebHeader(request, http::field::origin));
  if (!origin.empty() && !IsOwn(origin, host) && !IsNamed(origin))
    return Refusal{http::status::forbidden, "a page of the site " + origin.substr(0, 100)};
  const std::string asked = LowerCase(WebHeader(request, http::field::host));
  if (!IsOwn("http://" + asked, host) && !IsNamed("http://" + asked) &&
      !IsNamed("https://" + asked))
    return Refusal{http::status::misdirected_request, "a request for another host"};
  return {};
}

bool WebVisitors::HasToken(const WebRequest& request) const {
  if (ShowsToken(WebHeader(request, http::field::authorization), "Bearer ", token_)) return true;
  const string_view target(request.target().data(), request.target().size());
  return ShowsToken(WebParameter(target, "token").value_or(""), "", token_);
}

std::string WebVisitors::NamedOrigin(const WebRequest& request) const {
  std::string origin = LowerCase(WebHeader(request, http::field::origin));
  return IsNamed(origin) ? origin : "";
}

}  // namespace vm
