#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace ssm {

/// True if the sentence ends with the sign at byte `at`: . ! ? before a blank (quotes and brackets
/// between) that no lower-case letter follows, but not the full stop of a title ("Dr. Watson") or
/// of a single letter; or their wide forms.
bool EndsSentence(std::string_view text, std::size_t at);

/// The sentences of a text, one behind the other without a gap: each with what follows it up to the
/// next one's first letter. Not empty unless the text is.
std::vector<std::string_view> CutSentences(std::string_view text);

}  // namespace ssm
