#pragma once

#include <optional>
#include <string_view>

namespace vxml {

// What the attributes of EmotionML may look like (EmotionML 1.0, schema).

/// Whether a list of words parted by blanks holds the word.
bool Contains(std::string_view list, std::string_view word);
/// A finite number, blanks around it allowed.
std::optional<double> Number(std::string_view text);
/// A whole number of milliseconds.
bool IsWhole(std::string_view text, bool may_be_negative);
/// An XML name without colons; what is beyond ASCII is taken for letters.
bool IsId(std::string_view text);

}  // namespace vxml
