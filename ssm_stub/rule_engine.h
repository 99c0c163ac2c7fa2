#pragma once

#include <memory>

#include "ssm/voice/speech_engine.h"

namespace ssm_stub {

/// An engine made of tables: phonemes by spelling rules, durations by phoneme (phoneme_table.cc),
/// silence for sound. The same text gives the same plan on every machine, to the millisecond.
///
/// Text with kana is Japanese, with the original's phoneme names. So is text of which every word
/// can be read as romaji, has at least two morae in all, and holds no common English word.
/// Everything else is English, with flite's names. Latin words in a Japanese text are romaji if
/// they can be, else English; digits are named one by one. A character without a reading (kanji
/// and the like) is "a u", and the plan says so. Punctuation makes pauses, other signs nothing.
///     kEdgePause, phonemes and pauses, kEdgePause      ("sil" at the edges in Japanese, else
///     "pau")
/// Voices: named as flite's, so that a script runs with either; all alike.
std::unique_ptr<ssm::SpeechEngine> MakeRuleEngine();

}  // namespace ssm_stub
