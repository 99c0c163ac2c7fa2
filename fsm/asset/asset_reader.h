#pragma once

#include <string>
#include <string_view>

#include "fsm/rig/head_asset.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Tells whether the file is glTF with our extension; checks nothing else.
bool IsAsset(std::string_view bytes);

/// Returns the head of a file made by WriteAsset. `name` appears in error messages. Nothing outside
/// `bytes` is read. Errors: kBadValue, naming file and member.
vm::Result<HeadAsset> ParseAsset(const std::string& name, std::string_view bytes);

}  // namespace fsm
