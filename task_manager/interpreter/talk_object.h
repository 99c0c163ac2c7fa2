#pragma once

#include <string>

#include "task_manager/platform/platform.h"
#include "task_manager/script/engine.h"

namespace vxml {

/// The object builtin:chat, as documents write it and see its result (docs/dialogs.md).

/// Takes one <param>. Returns what is wrong with it, "" if nothing is.
std::string SetTalkParameter(const std::string& name, const std::string& value,
                             TalkRequest& request);
/// The value of the item's variable.
script::Value ResultOfTalk(script::Engine& engine, const TalkResult& result);

}  // namespace vxml
