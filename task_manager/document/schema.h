#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vxml {

/// What may stand in an element, and which of its attributes exclude or need each other
/// (VoiceXML 2.0 appendix O, 2.1 appendix C, the sections of the elements).
struct ElementRule {
  std::string_view name;
  std::string_view children;    ///< names with blanks between; @exec, @prompt, @handlers name sets
  std::string_view attributes;  ///< all it knows; '!' in front marks a required one
  bool text = false;            ///< character data allowed
};
const ElementRule* FindElementRule(std::string_view name);
/// True if `child` may stand in `rule`'s element.
bool Allows(const ElementRule& rule, std::string_view child);

/// True if SSML 1.1 has an element of that name.
bool IsSpeechName(std::string_view name);
/// True if the element knows the attribute (those of fetching included).
bool KnowsAttribute(const ElementRule& rule, std::string_view name);

struct AttributeChoice {
  std::string_view element;
  std::string_view names;  ///< of these
  int min;                 ///< at least so many
  int max;                 ///< and at most so many
};
const std::vector<AttributeChoice>& AttributeChoices();

std::vector<std::string_view> SplitWords(std::string_view words);
/// Whether the word is one of the list, which has blanks between them.
bool HasWord(std::string_view list, std::string_view word);

}  // namespace vxml
