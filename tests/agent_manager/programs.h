#pragma once

#include <string>

/// The programs that process tests start.
inline const std::string kHub = GALATEA_BIN_DIR "/agent_manager";
inline const std::string kModule = GALATEA_BIN_DIR "/test_module";
