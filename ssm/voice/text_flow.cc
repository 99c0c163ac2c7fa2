#include "ssm/voice/text_flow.h"

#include <utility>

#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/word_signs.h"

namespace ssm {

void TextFlow::Blank() {
  if (sentence_) return;
  if (!blank_) builder_.Text(" ");
  blank_ = true;
}

void TextFlow::Say(std::string_view written, std::string_view spoken) {
  if (spoken.empty()) return;
  const bool edge = std::exchange(edge_, false), blank = std::exchange(blank_, false);
  const char32_t first = FirstSign(AsWritten(spoken)), first_written = FirstSign(written);
  const char32_t before = std::exchange(last_, LastSign(AsWritten(spoken)));
  if (std::exchange(sentence_, false) && before != 0) {
    // Between scripts without blanks it is seen only: their engines would make a pause of it.
    const bool spaced = IsOfSpacedScript(before) && IsOfSpacedScript(first);
    if (!blank && spaced) builder_.Text(" ");
    if (!blank && !spaced) builder_.Written(" ");
    builder_.BeginSentence();
  } else if (edge && !blank && (PartsWords(before, first) || PartsWords(before, first_written))) {
    builder_.Text(" ");
  }
  builder_.Text(written, spoken);
}

void TextFlow::OpenToken() {
  Edge();
  ++tokens_;
}

void TextFlow::CloseToken() {
  --tokens_;
  Edge();
}

}  // namespace ssm
