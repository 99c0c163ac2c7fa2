#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vm {

class JsonEntry;
struct HttpRequest;

/// The address of `call` ("/chat/completions") of an OpenAI-compatible endpoint below `base`, which
/// may name the call already, or end in /v1. `whose` names it in errors ("a model").
/// Errors: kBadValue for anything but http and https, and for a user or a password within.
Result<std::string> EndpointUrl(std::string_view base, std::string_view call,
                                const std::string& whose);

/// Where a server is, how it is asked, and what bounds its answer. Constant.
struct ServerSettings {
  std::string url{};        ///< of the call, as EndpointUrl gives it
  std::string key{};        ///< sent as a bearer token; empty: none is; never shown
  std::string ca_file{};    ///< PEM: who signs the server's certificate; empty: the system's
  std::string more = "{}";  ///< JSON: further members of each request
  std::chrono::milliseconds limit{60'000};  ///< for one answer
  std::chrono::milliseconds stall{20'000};  ///< without anything new
  std::size_t max_bytes = 32u << 20;        ///< of one answer
};

/// The keys `url key_file ca_file body limit_ms stall_ms max_bytes` of a configuration in `folder`,
/// with `usual` for those that are not there; then Check. The caller asks the entry for its own
/// keys before. Errors: kBadValue, kUnavailable (the key's file).
Result<ServerSettings> ReadServer(JsonEntry& entry, const std::string& folder,
                                  std::string_view call, const std::string& whose,
                                  ServerSettings usual = {});
/// A POST as the settings say, yet without a body.
HttpRequest RequestTo(const ServerSettings& server);

}  // namespace vm
