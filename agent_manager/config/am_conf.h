#pragma once

#include <string>
#include <string_view>

#include "agent_manager/config/config.h"

namespace am {

/// True for a text in the form of the original's configuration (am.conf) rather than JSON.
bool IsAmConf(std::string_view text);

/// Reads the original's configuration: `broadcast: NAME...`, `module:NAME commands: SHELL LINE`,
/// `#` comments (docs/configuration.md). Modules that are parts of this hub are left out and named
/// in Config::notes. Errors: kBadValue with the file and the line.
vm::Result<Config> ParseAmConf(std::string_view text, const std::string& origin);

}  // namespace am
