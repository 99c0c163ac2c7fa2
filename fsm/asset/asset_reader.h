#pragma once

#include <string>
#include <string_view>

#include "fsm/rig/head_asset.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// True if the file is glTF with our extension; nothing else about it is looked at.
bool IsAsset(std::string_view bytes);

/// The head of a file that WriteAsset has made. `name` is for messages. Nothing outside the bytes
/// is read. Errors: kBadValue and kLimit, naming file and member.
vm::Result<HeadAsset> ParseAsset(const std::string& name, std::string_view bytes);

}  // namespace fsm
