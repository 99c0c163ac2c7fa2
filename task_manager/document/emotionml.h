#pragma once

#include <vector>

#include "task_manager/document/vxml_document.h"

namespace vxml {

inline constexpr std::string_view kEmotionMlSpace = "http://www.w3.org/2009/10/emotionml";

/// True for a document of EmotionML: <emotionml>, or an <emotion> of its namespace by itself.
bool IsEmotionMl(const vm::xml::Node& root);
/// Checks a document by the rules of EmotionML 1.0 (sections 2 and 3): elements, attributes, value
/// ranges, vocabularies declared and known. Names of the vocabularies of "Vocabularies for
/// EmotionML" are tables here; vocabularies of other documents are not fetched (a warning).
std::vector<Finding> CheckEmotionMl(const vm::xml::Node& root);

}  // namespace vxml
