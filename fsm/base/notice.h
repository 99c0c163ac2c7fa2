#pragma once

#include <iostream>
#include <string>

namespace fsm {

/// Tells people, on stderr, what is odd but no reason to stop.
inline void Notice(const std::string& text) { std::cerr << "fsm: notice: " << text << "\n"; }

}  // namespace fsm
