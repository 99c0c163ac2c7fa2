#include "ssm/voice/emoji.h"

#include <utf8proc.h>

#include "ssm/voice/word_signs.h"
#include "vm_protocol/core/utf8.h"

namespace ssm {
namespace {

constexpr char32_t kTextSelector = 0xFE0E, kEmojiSelector = 0xFE0F, kKeycap = 0x20E3,
                   kJoiner = 0x200D;

bool IsPictograph(char32_t sign) {
  return utf8proc_get_property(static_cast<utf8proc_int32_t>(sign))->boundclass ==
         UTF8PROC_BOUNDCLASS_EXTENDED_PICTOGRAPHIC;
}

/// Pictographs that are punctuation, letters or arrows too: © ® ‼ ⁉ ™ ℹ 〰 〽 ㊗ ㊙.
bool IsTextToo(char32_t sign) { return sign < 0x2190 || (sign >= 0x3000 && sign < 0x3400); }

bool IsPartOfEmoji(char32_t sign) {
  return (sign >= 0x1F1E6 && sign <= 0x1F1FF) ||  // the letters of flags
         (sign >= 0x1F3FB && sign <= 0x1F3FF) ||  // skin tones
         (sign >= 0xE0020 && sign <= 0xE007F) ||  // tags
         sign == kTextSelector || sign == kEmojiSelector || sign == kKeycap;
}

}  // namespace

std::string WithoutEmoji(std::string_view text) {
  const std::u32string signs = vm::SignsOf(text);
  std::u32string kept;
  bool gap = false;  // an emoji stood here
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const char32_t sign = signs[i], next = i + 1 < signs.size() ? signs[i + 1] : 0;
    const bool pictograph =
        IsPictograph(sign) && next != kTextSelector && (!IsTextToo(sign) || next == kEmojiSelector);
    // Elsewhere a joiner belongs to the letters of a script.
    if (pictograph || IsPartOfEmoji(sign) || (gap && sign == kJoiner)) {
      gap = gap || (sign != kTextSelector && sign != kEmojiSelector && sign != kKeycap);
      continue;
    }
    if (gap && !kept.empty()) {
      const bool word = IsWordSign(sign);
      if (kept.back() == U' ' && !word && sign != U' ') kept.pop_back();
      if (IsWordSign(kept.empty() ? 0 : kept.back()) && word && IsOfSpacedScript(sign))
        kept += U' ';
    }
    gap = false;
    kept += sign;
  }
  return vm::Utf8Of(kept);
}

}  // namespace ssm
