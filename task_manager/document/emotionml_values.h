#pragma once

#include <optional>
#include <string_view>

namespace vxml {

// What the attributes of EmotionML may look like (EmotionML 1.0, schema).

/// A finite number, blanks around it and a sign allowed.
std::optional<double> Number(std::string_view text);
/// A whole number (xs:integer); "+5" is one.
bool IsWhole(std::string_view text, bool may_be_negative);
/// An XML name without colons; what is beyond ASCII is taken for letters.
bool IsId(std::string_view text);
/// A name token (xs:NMTOKEN): as an id, but any of its characters and ':' may come first.
bool IsToken(std::string_view text);
/// A reference of RFC 3986, or of RFC 3987 with letters beyond ASCII.
bool IsUri(std::string_view text);
/// "audio/x-wav" (RFC 2046), perhaps with parameters.
bool IsMediaType(std::string_view text);

}  // namespace vxml
