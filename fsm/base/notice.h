#pragma once

#include <iostream>
#include <string>

namespace fsm {

/// Prints a warning to stderr: something is unusual, but the program can go on.
inline void Notice(const std::string& text) { std::cerr << "fsm: notice: " << text << "\n"; }

}  // namespace fsm
