#pragma once

#include <string>

namespace vm {

/// A variable of the environment; empty where it is not set.
std::string Environment(const char* name);

/// The folder galatea in one of the user's folders by the XDG Base Directory Specification:
/// $`variable`/galatea, else ~/`beneath_home`/galatea; empty without a home.
std::string UserFolder(const char* variable, const char* beneath_home);

}  // namespace vm
