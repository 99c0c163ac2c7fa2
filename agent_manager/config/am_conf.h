#pragma once

#include <string>
#include <string_view>

#include "agent_manager/config/config.h"

namespace am {

/// Returns true if the first line that is no comment begins as the original's configuration
/// (am.conf) does; otherwise the text is taken for JSON.
bool IsAmConf(std::string_view text);

/// Reads the original's configuration: `broadcast: NAME...`, `module:NAME commands: SHELL LINE`,
/// `#` comments (docs/configuration.md). Modules whose work this hub does itself (@AM, @AM-MCL,
/// @FS-MCL, @PAR) are left out and named in Config::notes. `origin` names the file in errors.
/// Errors: kBadValue with the file and the line.
vm::Result<Config> ParseAmConf(std::string_view text, const std::string& origin);

}  // namespace am
