#include "fsm/head/identity.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "fsm/head/head.h"

namespace fsm {
namespace {

constexpr std::array kIdentities = {
    IdentityInfo{"galatea", "a woman in her twenties, chestnut hair to the shoulders, brown eyes"},
    IdentityInfo{"pygmalion", "a man in his thirties, short dark hair, grey-blue eyes"},
    IdentityInfo{"baucis", "a woman of seventy, grey hair, green eyes"},
};

}  // namespace

std::span<const IdentityInfo> Head::Identities() { return kIdentities; }

std::size_t IdentityIndex(std::string_view name) {
  const auto found = std::ranges::find(kIdentities, name, &IdentityInfo::name);
  if (found != kIdentities.end()) return static_cast<std::size_t>(found - kIdentities.begin());
  std::string names;
  for (const IdentityInfo& identity : kIdentities) {
    names += (names.empty() ? "" : ", ") + std::string(identity.name);
  }
  throw std::invalid_argument("there is no face '" + std::string(name) + "'; there is " + names);
}

}  // namespace fsm
