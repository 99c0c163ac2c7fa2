#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "srm/engine/decoder.h"
#include "srm/engine/endpointer.h"

namespace srm {

/// Sound in, utterances out: end-pointing, decoding, spotting of single phrases.
/// Thread: none of its own; decoding is done within Feed (about 1 % of the sound's time with a
/// grammar, 10 % in dictation).
class Ear {
 public:
  struct Heard {
    Hypothesis hypothesis{};
    Millis start{0};   ///< of the first sound handed over, in the sound's own time
    Millis length{0};  ///< with the silence that ended it
    std::vector<std::int16_t> sound{};
    bool longest = false;  ///< ended because it was too long
  };
  struct Events {
    std::function<void()> began;  ///< somebody speaks
    std::function<void(const std::string& text)> partial;
    std::function<void(const Heard&)> ended;
    std::function<void(const std::string& phrase)> spotted;
    /// Whether a text is a whole phrase (Endpointer::Settings::complete). May be empty.
    std::function<bool(const std::string& text)> whole{};
  };
  /// `spotter` may be null. The grammar must be set by Use before sound comes.
  Ear(std::unique_ptr<SpeechDecoder> decoder, std::unique_ptr<KeywordSpotter> spotter,
      Endpointer::Settings settings, Events events);

  void Feed(std::span<const std::int16_t> samples);
  /// Nothing more comes: what is going on is ended.
  void Finish();
  /// Drops what is going on.
  void Reset();
  /// Other grammars, empty = dictation. In the middle of an utterance it is decoded again from its
  /// beginning, so nothing said is lost.
  vm::Result<void> Use(const std::vector<const ear::Grammar*>& grammars);
  vm::Result<void> Pronounce(const std::string& word, const std::string& spoken) {
    return decoder_->Pronounce(word, spoken);
  }
  void set_most(std::size_t most) { decoder_->set_most(most); }
  vm::Result<void> Spot(const std::vector<std::string>& phrases);
  /// False: sound is only searched for phrases to spot (the agent is speaking itself).
  void set_recognizing(bool recognizing);
  Endpointer::Settings& settings() { return endpointer_.settings(); }
  bool in_speech() const { return endpointer_.in_speech(); }

 private:
  static constexpr std::size_t kPartialSamples = 100 * kFramesPerMs;
  void OnBegin();
  void OnSound(std::span<const std::int16_t> samples);
  void OnEnd();
  bool IsComplete();
  /// Decodes what has come, and tells of other words than before.
  void Decode();

  const std::unique_ptr<SpeechDecoder> decoder_;
  const std::unique_ptr<KeywordSpotter> spotter_;
  const Events events_;
  Endpointer endpointer_;
  bool recognizing_ = true;
  bool decoding_ = false;
  std::size_t fed_ = 0;  // samples since the start
  std::size_t last_partial_ = 0;
  std::string partial_;
  Millis start_{0};
  std::vector<std::int16_t> utterance_;
};

}  // namespace srm
