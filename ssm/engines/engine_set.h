#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// Several engines as one. A span goes to the engine that has its voice; runs in another language
/// (SplitLanguages, or the span's own word for it) to the voice of that language: the one chosen,
/// else one of the speaker's sex, else the first. A text with ideographs and without kana goes to
/// the voice of Chinese, if there is one, where its ideographs are none of Japanese, or where the
/// voice of Japanese leaves some of them out. Sound files (SpeechSpan::audio) are played here.
/// Where the language changes inside a sentence, the engines' silences there are cut to kJoint.
/// Thread: as the engines; ChooseVoice may be called at any time.
class EngineSet final : public SpeechEngine {
 public:
  static constexpr Millis kJoint{40};

  /// REQUIRES: at least one engine. A voice of a name that an earlier engine has is not reached.
  explicit EngineSet(std::vector<std::unique_ptr<SpeechEngine>> engines);

  const std::vector<VoiceInfo>& voices() const override { return voices_; }
  bool Speaks(const std::string& language) const override;
  vm::Result<SpeechPlan> Plan(const std::vector<SpeechSpan>& spans,
                              const std::atomic<bool>& cancelled) override;
  vm::Result<void> Render(const SpeechPlan& plan, SampleBuffer& samples) override;
  bool Prompt(const std::vector<SpeechSpan>& spans) const override;
  vm::Result<void> ChooseVoice(const std::string& language, const std::string& voice) override;

 private:
  struct Run {
    std::size_t engine = 0;
    std::vector<SpeechSpan> spans;
    bool joined = false;  ///< follows the one before inside a sentence
  };
  std::size_t IndexOf(std::string_view voice) const;
  std::size_t VoiceFor(const std::string& language, std::size_t base) const;
  /// The language of the ideographs whose language nobody has said, as far as they themselves tell.
  std::string LanguageOfIdeographs(const std::vector<SpeechSpan>& spans) const;
  std::vector<Run> Runs(const std::vector<SpeechSpan>& spans, const std::string& ideographs) const;
  vm::Result<SpeechPlan> PlanRuns(const std::vector<Run>& runs, const std::atomic<bool>& cancelled);

  const std::vector<std::unique_ptr<SpeechEngine>> engines_;
  std::vector<VoiceInfo> voices_;
  std::vector<std::size_t> engine_of_;  // beside voices_
  mutable std::mutex mutex_;
  std::map<std::string, std::size_t> chosen_;  // guarded by mutex_: language -> voice
};

}  // namespace ssm
