#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// An engine whose sentences are analysed whole. Marks, pauses and changes of manner inside a
/// sentence never reach the engine below: it gets the text as if they were not there, and they are
/// laid over its words afterwards. So they change neither pronunciation nor pauses, and nothing
/// but the words they enclose. A sentence that has one manner throughout is spoken in it by the
/// engine itself; of a mixed one the engine gets the outermost manner.
///   a mark      stands where the next word begins, behind the last one where that ends
///   a pause     is put in before the next word, behind the last one at the end; it adds to the
///               engine's own
///   a manner    lengthens, raises and amplifies from its first word to its last, by overlap and
///               add of the engine's sound (reshape.h); what is outside of it stays as it was
/// A new voice, another language asked for, or a sound file does part a sentence.
/// Sound that nothing was laid over comes as early as the engine's own; else when all is there.
/// Thread and errors: those of the engine below.
class LayeredEngine final : public SpeechEngine {
 public:
  explicit LayeredEngine(std::unique_ptr<SpeechEngine> engine) : engine_(std::move(engine)) {}

  const std::vector<VoiceInfo>& voices() const override { return engine_->voices(); }
  bool Speaks(const std::string& language) const override { return engine_->Speaks(language); }
  vm::Result<SpeechPlan> Plan(const std::vector<SpeechSpan>& spans,
                              const std::atomic<bool>& cancelled) override;
  vm::Result<void> Render(const SpeechPlan& plan, SampleBuffer& samples) override;
  bool Prompt(const std::vector<SpeechSpan>& spans) const override;
  vm::Result<void> ChooseVoice(const std::string& language, const std::string& voice) override {
    return engine_->ChooseVoice(language, voice);
  }

 private:
  const std::unique_ptr<SpeechEngine> engine_;
};

}  // namespace ssm
