#pragma once

#include <array>
#include <string_view>

namespace am {

/// What a peer is to the hub. What each may do: rights.h and docs/security.md.
enum class Role {
  kOwner,   ///< the console: the process that started the hub
  kModule,  ///< started by the hub, or connected to by its configuration
  kClient,  ///< came over a Unix socket, from the same user
  kGuest,   ///< came over TCP, TLS, the page or MQTT
};
inline constexpr std::array<Role, 4> kRoles{Role::kOwner, Role::kModule, Role::kClient,
                                            Role::kGuest};

/// "owner", "module", "client", "guest".
std::string_view RoleName(Role role);

}  // namespace am
