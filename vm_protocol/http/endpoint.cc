#include "vm_protocol/http/endpoint.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "vm_protocol/core/utf8.h"
#include "vm_protocol/http/http.h"
#include "vm_protocol/http/json_entry.h"
#include "vm_protocol/runtime/credentials.h"

namespace vm {

Result<std::string> EndpointUrl(std::string_view base, std::string_view call,
                                const std::string& whose) {
  const std::size_t scheme = base.find("://");
  const bool known = base.starts_with("http://") || base.starts_with("https://");
  const std::size_t host = known ? scheme + 3 : 0;
  const std::size_t end = std::min(base.find_first_of("/?#", host), base.size());
  if (!known || end == host) {
    return Fail(Errc::kBadValue, "'" + ShownUtf8(CutUtf8(base, 200)) + "' is no address of " +
                                     whose + ", expected http://HOST:PORT or https://HOST");
  }
  if (base.substr(host, end - host).contains('@')) {
    return Fail(Errc::kBadValue, "a user and a password do not belong into the address of " +
                                     whose + "; put the key into a file");
  }
  const bool plain = std::ranges::all_of(base, [](char c) { return c > ' ' && c < 0x7F; });
  if (!plain || base.contains('?') || base.contains('#')) {
    return Fail(Errc::kBadValue,
                "the address of " + whose + " has blanks, '?', '#' or signs beyond ASCII");
  }
  std::string url(base);
  while (url.ends_with('/')) url.pop_back();
  if (url.ends_with(call)) return url;
  return url + (url.ends_with("/v1") ? "" : "/v1") + std::string(call);
}

Result<ServerSettings> ReadServer(JsonEntry& entry, const std::string& folder,
                                  std::string_view call, const std::string& whose,
                                  ServerSettings server) {
  const std::string base = entry.Text("url");
  const std::string key_file = PathBeside(folder, entry.Text("key_file", ""));
  server.ca_file = PathBeside(folder, entry.Text("ca_file", ""));
  server.limit = entry.Limit("limit_ms", server.limit);
  server.stall = entry.Limit("stall_ms", server.stall);
  server.max_bytes = static_cast<std::size_t>(entry.Number(
      "max_bytes", static_cast<std::int64_t>(server.max_bytes), 1000, std::int64_t{1} << 30));
  if (const nlohmann::json* more = entry.Find("body")) {
    if (!more->is_object()) entry.Bad("body", "an object");
    server.more = more->dump();
  }
  if (auto good = entry.Check(); !good) return std::unexpected(good.error());
  auto url = EndpointUrl(base, call, whose);
  if (!url) return std::unexpected(url.error());
  server.url = std::move(*url);
  if (!key_file.empty()) {
    auto key = ReadSecret(key_file, "key", 1);
    if (!key) return std::unexpected(key.error());
    server.key = std::move(*key);
  }
  return server;
}

HttpRequest RequestTo(const ServerSettings& server) {
  HttpRequest request{.url = server.url, .limit = server.limit, .max_bytes = server.max_bytes};
  if (!server.key.empty()) request.headers.push_back("Authorization: Bearer " + server.key);
  return request;
}

}  // namespace vm
