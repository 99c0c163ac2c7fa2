#include "ssm/voice/word_signs.h"

#include <utf8proc.h>

#include <algorithm>
#include <array>

#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

struct Range {
  char32_t first, last;
};
// Blocks of Unicode 15.
constexpr std::array<Range, 8> kUnspaced = {{{0x0E00, 0x109F},    // Thai, Lao, Tibetan, Burmese
                                             {0x1780, 0x17FF},    // Khmer
                                             {0x2E80, 0x312F},    // radicals, kana, Bopomofo
                                             {0x3190, 0xA4CF},    // Han, Yi
                                             {0xF900, 0xFAFF},    // Han for compatibility
                                             {0xFF61, 0xFF9F},    // narrow kana
                                             {0x1B000, 0x1B16F},  // more kana
                                             {0x20000, 0x3FFFF}}};

utf8proc_category_t KindOf(char32_t sign) {
  return utf8proc_category(static_cast<utf8proc_int32_t>(sign));
}

}  // namespace

bool IsWordSign(char32_t sign) {
  const utf8proc_category_t kind = KindOf(sign);
  return kind >= UTF8PROC_CATEGORY_LU && kind <= UTF8PROC_CATEGORY_NO;
}

bool IsOfSpacedScript(char32_t sign) {
  return std::ranges::none_of(
      kUnspaced, [sign](const Range& it) { return sign >= it.first && sign <= it.last; });
}

char32_t FirstSign(std::string_view text) { return text.empty() ? 0 : vm::SignAt(text, 0).value; }

char32_t LastSign(std::string_view text) {
  if (text.empty()) return 0;
  std::size_t at = text.size() - 1;
  while (at > 0 && !vm::BeginsSign(text[at])) --at;
  return vm::SignAt(text, at).value;
}

bool PartsWords(char32_t before, char32_t after) {
  constexpr std::u32string_view kEnding = U"%.,;:!?)]}…", kBeginning = U"#&@([{";
  if (before == 0 || after == 0) return false;
  if (!IsOfSpacedScript(before) || !IsOfSpacedScript(after)) return false;
  return (IsWordSign(before) || kEnding.contains(before)) &&
         (IsWordSign(after) || kBeginning.contains(after) || KindOf(after) == UTF8PROC_CATEGORY_SC);
}

}  // namespace ssm
