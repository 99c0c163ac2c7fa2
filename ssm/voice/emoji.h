#pragma once

#include <string>
#include <string_view>

namespace ssm {

/// The text without emoji, which nobody speaks: Unicode's extended pictographs (emoji-data.txt; of
/// signs that are text as well, such as ™ and ‼, only those that a variation selector makes
/// emoji), skin tones, flags, what joins them, tags, variation selectors, the frame of a keycap.
/// Words that only an emoji parted stay parted; before a sign nothing is left of it. Pure.
std::string WithoutEmoji(std::string_view text);

}  // namespace ssm
