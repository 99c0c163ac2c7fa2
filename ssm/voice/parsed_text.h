#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace ssm {

/// An analysis made by hand, in the form the original read (ParsedText): elements S, AP (accent
/// phrase), W1, W2 and PRON, words as <W2 orth="今日" pron="キョー" .../>, and the tags of
/// JEIDA-62-2000 between. As a text with tags: each word in its reading. Attributes that tell
/// accents and parts of speech are not used. Errors: kSyntax with the line, kBadValue (no word).
vm::Result<std::string> TextOfParsed(std::string_view xml);

}  // namespace ssm
