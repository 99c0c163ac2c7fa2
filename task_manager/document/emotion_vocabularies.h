#pragma once

#include <string_view>

namespace vxml {

/// A vocabulary of "Vocabularies for EmotionML" (W3C note).
struct EmotionVocabulary {
  std::string_view id;
  std::string_view type;   ///< category, dimension, appraisal, action-tendency
  std::string_view names;  ///< with blanks between
};
/// Null if there is none of that id.
const EmotionVocabulary* FindEmotionVocabulary(std::string_view id);

}  // namespace vxml
