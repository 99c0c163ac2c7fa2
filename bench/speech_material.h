#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "ssm/voice/speech_engine.h"

/// What the speech benches say and how they count: the phrases, the voices, noise, time.
namespace speech_bench {

using Samples = std::vector<std::int16_t>;

struct Speech {
  ssm::SpeechPlan plan{};
  Samples samples{};
};

/// The 30 phrases of the grammar, and 50 everyday sentences that share words with them now and
/// then but are not in it.
const std::vector<std::string>& Phrases();
const std::vector<std::string>& OtherSentences();
/// What may be said at some place of a dialogue, and what else somebody says there: near misses and
/// everyday words.
struct SmallGrammar {
  std::vector<std::string> inside{}, outside{};
};
/// 12 grammars of three to six phrases; by the first six the threshold of rejection was set.
const std::vector<SmallGrammar>& SmallGrammars();
/// 20 polite phrases of Japanese, written in kana, one word between blanks.
const std::vector<std::string>& JapanesePhrases();

/// Empty samples if the engine cannot say it.
Speech Say(ssm::SpeechEngine& engine, const std::string& text, const std::string& voice);
/// White noise at a ratio to the speech's power, the same each time.
Samples WithNoise(Samples samples, double ratio_db);
/// Seconds of this process's own work, whatever else the machine does.
double CpuSeconds();
double SoundSeconds(const Samples& samples);

}  // namespace speech_bench
