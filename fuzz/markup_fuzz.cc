// What may stand in a text to be spoken: SSML, JEIDA tags, plain text; cut into languages and
// sentences. All text of the spans comes from the input or stands for a part of it.
#include <cstddef>
#include <cstdint>
#include <string>

#include "ssm/engines/language_runs.h"
#include "ssm/engines/piece_engine.h"
#include "ssm/voice/ssml.h"
#include "ssm/voice/text_tags.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const std::string& whole : {text, "<speak>" + text + "</speak>"}) {
    const auto read = ssm::ReadMarkup(whole);
    if (!read) continue;
    for (const ssm::SpeechSpan& span : read->spans) {
      if (!(span.stretch > 0) || !(span.pitch > 0) || !(span.volume >= 0)) __builtin_trap();
      if (span.pause_before.count() < 0) __builtin_trap();
      static_cast<void>(ssm::SplitLanguages(span.text, "en"));
      for (const std::string& sentence : ssm::SplitUtf8Sentences(span.text)) {
        if (sentence.empty()) __builtin_trap();
      }
    }
  }
  return 0;
}
