#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/head/identity.h"

namespace fsm {

/// A built-in face as its table has it. Throws as ReadIdentity.
Identity BuiltInIdentity(std::string_view name);
/// The sliders there are, in the order of their table.
std::vector<std::string> SliderNames();

/// A face of one's own, the file identity.txt in its folder: `base FACE`, then lines as in
/// tables/identities.txt that change it. `name` is for messages. Throws std::runtime_error naming
/// file and line. Limit: kMostSlider either way.
Identity ReadOwnIdentity(const std::string& name, std::string_view text);
/// Such a file with sliders only.
std::string WriteOwnIdentity(std::string_view base,
                             const std::map<std::string, float, std::less<>>& sliders);
inline constexpr float kMostSlider = 10;

}  // namespace fsm
