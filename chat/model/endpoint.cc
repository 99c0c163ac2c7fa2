#include "chat/model/endpoint.h"

#include <algorithm>

#include "vm_protocol/core/message.h"
#include "vm_protocol/core/utf8.h"

namespace chat {

using vm::Errc;
using vm::Fail;

vm::Result<std::string> ChatUrl(std::string_view base) {
  const std::size_t scheme = base.find("://");
  const bool known = base.starts_with("http://") || base.starts_with("https://");
  const std::size_t host = known ? scheme + 3 : 0;
  const std::size_t end = std::min(base.find_first_of("/?#", host), base.size());
  if (!known || end == host) {
    return Fail(Errc::kBadValue,
                "'" + vm::ShownUtf8(vm::CutUtf8(base, 200)) +
                    "' is no address of a model, expected http://HOST:PORT or https://HOST");
  }
  if (base.substr(host, end - host).contains('@')) {
    return Fail(Errc::kBadValue,
                "a user and a password do not belong into the address of a model; "
                "put the key into a file");
  }
  const bool plain = std::ranges::all_of(base, [](char c) { return c > ' ' && c < 0x7F; });
  if (!plain || base.contains('?') || base.contains('#')) {
    return Fail(Errc::kBadValue,
                "the address of a model has blanks, '?', '#' or signs beyond ASCII");
  }
  std::string url(base);
  while (url.ends_with('/')) url.pop_back();
  if (url.ends_with("/chat/completions")) return url;
  return url + (url.ends_with("/v1") ? "/chat/completions" : "/v1/chat/completions");
}

vm::Result<AllowedSlot> ParseAllowed(std::string_view text) {
  const std::size_t blank = std::min(text.find(' '), text.size());
  AllowedSlot allowed{std::string(text.substr(0, blank)),
                      std::string(text.substr(std::min(blank + 1, text.size())))};
  if (allowed.module.starts_with('@')) allowed.module.erase(0, 1);
  if (!vm::IsModuleName(allowed.module) || !vm::IsSlotName(allowed.slot)) {
    return Fail(Errc::kBadValue, "found '" + std::string(text) + "', expected @MODULE SLOT");
  }
  return allowed;
}

}  // namespace chat
