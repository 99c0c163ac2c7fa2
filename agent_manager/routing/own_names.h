#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace am {

/// Names under which the hub and its parts speak and are spoken to.
namespace own_name {
inline constexpr const char* kHub = "AM";
inline constexpr const char* kMacros = "AM-MCL";
inline constexpr const char* kMacrosOfTheOriginal = "FS-MCL";
inline constexpr const char* kParallel = "PAR";
inline constexpr const char* kSound = "SND";
inline constexpr const char* kConsole = "CONSOLE";
inline constexpr const char* kReplay = "REPLAY";
inline constexpr const char* kBroker = "MQTT";
}  // namespace own_name

/// Those that only the hub can have; a module may take the place of @PAR and @SND.
inline constexpr std::array<std::string_view, 6> kReservedNames{
    own_name::kHub,     own_name::kMacros, own_name::kMacrosOfTheOriginal,
    own_name::kConsole, own_name::kReplay, own_name::kBroker};

inline bool IsReservedName(std::string_view name) {
  return std::ranges::find(kReservedNames, name) != kReservedNames.end();
}

}  // namespace am
