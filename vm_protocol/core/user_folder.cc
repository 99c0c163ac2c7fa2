#include "vm_protocol/core/user_folder.h"

#include <cstdlib>

namespace vm {

std::string Environment(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string UserFolder(const char* variable, const char* beneath_home) {
  if (const auto named = Environment(variable); !named.empty()) return named + "/galatea";
  const auto home = Environment("HOME");
  return home.empty() ? "" : home + "/" + beneath_home + "/galatea";
}

}  // namespace vm
