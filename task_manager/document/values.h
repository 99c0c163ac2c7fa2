#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

namespace vxml {

/// What is wrong with an attribute's value, "" if nothing is: the enumerations, counts and time
/// designations of the VoiceXML 2.1 schema. Attributes whose values are free are never wrong.
std::string WrongValue(std::string_view element, std::string_view attribute,
                       std::string_view value);

/// Digits, perhaps with a fraction, then "s" or "ms" (VoiceXML 2.0 section 6.5).
bool IsTimeDesignation(std::string_view text);

/// What a time designation says ("5s", "250ms", "1.5s", "+2s"); none if it is none.
std::optional<std::chrono::milliseconds> ParseTime(std::string_view text);

/// The number a text begins with, brought between `min` and `max`; `otherwise` if it is none.
double NumberIn(std::string_view text, double min, double max, double otherwise);

}  // namespace vxml
