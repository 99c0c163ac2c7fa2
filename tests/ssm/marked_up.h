#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ssm/engines/espeak_engine.h"
#include "ssm/voice/ssml.h"
#include "tests/ssm/spoken.h"

/// What engines make of SSML.
namespace ssm_test {

/// The spans of what stands inside of <speak>, spoken by `voice` where nothing else is said.
inline std::vector<ssm::SpeechSpan> SpansOf(const std::string& inside, const std::string& voice,
                                            const ssm::MarkupOptions& options = {}) {
  auto read = ssm::ReadMarkup("<speak version='1.1'>" + inside + "</speak>", options);
  EXPECT_TRUE(read) << inside << (read ? "" : read.error().text);
  if (!read) return {};
  for (ssm::SpeechSpan& span : read->spans) {
    if (span.voice.empty()) span.voice = voice;
  }
  return std::move(read->spans);
}

/// The names of the phonemes without pauses, and the words, with blanks between.
struct Said {
  std::string sounds{}, words{};
  bool operator==(const Said&) const = default;
};
inline Said SaidBy(ssm::SpeechEngine& engine, const std::string& inside, const std::string& voice,
                   const ssm::MarkupOptions& options = {}) {
  const Spoken spoken = Speak(engine, SpansOf(inside, voice, options));
  Said said;
  for (const vm::Phoneme& phoneme : spoken.plan.phonemes) {
    if (phoneme.name == "pau" || phoneme.name == "sil") continue;
    said.sounds += (said.sounds.empty() ? "" : " ") + phoneme.name;
  }
  for (const ssm::WordTime& word : spoken.plan.words) {
    said.words += (said.words.empty() ? "" : " ") + word.text;
  }
  return said;
}
inline void PrintTo(const Said& said, std::ostream* out) {
  *out << "[" << said.sounds << "] (" << said.words << ")";
}

/// None where the program is not built.
inline std::unique_ptr<ssm::SpeechEngine> Espeak() {
  const std::string helper = GALATEA_BIN_DIR "/ssm_espeak";
  if (access(helper.c_str(), X_OK) != 0) return nullptr;
  return ssm::MakeEspeakEngine({.helper = helper});
}

}  // namespace ssm_test
