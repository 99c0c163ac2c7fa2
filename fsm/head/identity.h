#pragma once

#include <cstddef>
#include <string_view>

namespace fsm {

/// The place of a name in Head::Identities(); throws std::invalid_argument listing the names.
std::size_t IdentityIndex(std::string_view name);

}  // namespace fsm
