#pragma once

#include <string>

namespace vxml {

/// Whose lines people want to see.
enum class Sides {
  kAgent,  ///< what is said and ended: the user is at the terminal and typed the rest
  kBoth,   ///< who said what when, with the face's feelings: "0:03.3 user: to Kyoto please"
};

/// A transcript line for people; "" for the rest.
std::string Readable(const std::string& json_line, Sides sides);

/// The stand-ins for speech without words: what input scripts write as nomatch.
bool IsUnknown(const std::string& utterance);

}  // namespace vxml
