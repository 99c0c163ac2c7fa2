#pragma once

#include <string_view>

namespace ssm {

/// True for letters, the marks on them, and figures, of any script.
bool IsWordSign(char32_t sign);
/// True for a sign of a script that parts words by blanks: all but Han, kana, Thai, Lao, Tibetan,
/// Burmese and Khmer.
bool IsOfSpacedScript(char32_t sign);
/// The first and the last sign of a text; 0 if it is empty.
char32_t FirstSign(std::string_view text);
char32_t LastSign(std::string_view text);

/// Whether two signs belong to two words where an element of a markup begins or ends between them:
/// `before` can end a word (a letter, a figure, %, closing punctuation), `after` can begin one (a
/// letter, a figure, a currency sign, # & @, an opening bracket). What follows a word without a
/// blank, as "cat's", "cat," and "well-known" do, stays with it, and so does everything in a script
/// without blanks.
bool PartsWords(char32_t before, char32_t after);

}  // namespace ssm
