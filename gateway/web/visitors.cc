#include "gateway/web/visitors.h"

#include <algorithm>

#include "vm_protocol/runtime/credentials.h"

namespace gateway {
namespace {

namespace http = boost::beast::http;
using std::string_view;

string_view Header(const HttpRequest& request, http::field name) {
  const auto text = request[name];
  return {text.data(), text.size()};
}

bool IsOwn(string_view site, string_view host) {
  return site == "http://" + std::string(host) ||
         site == "http://localhost" + std::string(host.substr(host.rfind(':')));
}

}  // namespace

std::optional<string_view> Parameter(string_view target, string_view name) {
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

bool Visitors::IsNamed(const std::string& site) const {
  return std::ranges::find(origins_, site) != origins_.end();
}

std::optional<Visitors::Refusal> Visitors::CheckSite(const HttpRequest& request,
                                                     string_view host) const {
  const std::string origin(Header(request, http::field::origin));
  if (!origin.empty() && !IsOwn(origin, host) && !IsNamed(origin))
    return Refusal{http::status::forbidden, "a page of the site " + origin.substr(0, 100)};
  const std::string asked(Header(request, http::field::host));
  if (!IsOwn("http://" + asked, host) && !IsNamed("http://" + asked) &&
      !IsNamed("https://" + asked))
    return Refusal{http::status::misdirected_request, "a request for another host"};
  return {};
}

bool Visitors::HasToken(const HttpRequest& request) const {
  const string_view header = Header(request, http::field::authorization);
  const string_view target(request.target().data(), request.target().size());
  const string_view shown =
      header.starts_with("Bearer ") ? header.substr(7) : Parameter(target, "token").value_or("");
  return vm::SameProof(std::string(shown), token_);
}

std::string Visitors::NamedOrigin(const HttpRequest& request) const {
  std::string origin(Header(request, http::field::origin));
  return IsNamed(origin) ? origin : "";
}

}  // namespace gateway
