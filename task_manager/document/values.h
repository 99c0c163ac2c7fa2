#pragma once

#include <string>
#include <string_view>

namespace vxml {

/// What is wrong with an attribute's value, "" if nothing is: the enumerations, counts and time
/// designations of the VoiceXML 2.1 schema. Attributes whose values are free are never wrong.
std::string WrongValue(std::string_view element, std::string_view attribute,
                       std::string_view value);

/// Digits, perhaps with a fraction, then "s" or "ms" (VoiceXML 2.0 section 6.5).
bool IsTimeDesignation(std::string_view text);

}  // namespace vxml
