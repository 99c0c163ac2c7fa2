#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace chat {

/// Where the model is and how it is asked; nothing is asked while `url` is empty. Constant.
struct Endpoint {
  std::string url;                     ///< of the requests, as ChatUrl gives it
  std::string key;                     ///< sent as a bearer token; never shown
  std::string more = "{}";             ///< JSON: further members of each request
  std::vector<std::string> allow_set;  ///< "@FSM Mask": slots the model may set
};

/// The address of chat completions below `base`, which may name it already, or end in /v1.
/// Errors: kBadValue for anything but http and https, and for a user or a password within.
vm::Result<std::string> ChatUrl(std::string_view base);

/// "@MODULE SLOT" taken apart. kBadValue for anything else.
struct AllowedSlot {
  std::string module, slot;
};
vm::Result<AllowedSlot> ParseAllowed(std::string_view text);

}  // namespace chat
