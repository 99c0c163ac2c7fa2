#include "chat/model/endpoint.h"

#include <algorithm>

#include "vm_protocol/core/message.h"
#include "vm_protocol/http/endpoint.h"

namespace chat {

using vm::Errc;
using vm::Fail;

vm::Result<std::string> ChatUrl(std::string_view base) {
  return vm::EndpointUrl(base, "/chat/completions", "a model");
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
