#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/inputs/motion_settings.h"
#include "fsm/motion/speech/speech_clock.h"
#include "fsm/motion/speech/speech_gestures.h"
#include "fsm/motion/speech/spoken_mouth.h"
#include "fsm/motion/speech/text_looks.h"
#include "fsm/motion/speech/viseme_track.h"

namespace fsm {

class IdleSwitches;
struct MotionInputs;
struct MotionTables;

/// Moves the face with utterances: the mouth on the layer `speech`, head, brows, eyes and lids on
/// `gestures`, the looks of the text (TextCues) on `text`. Gives the signals `speaking`,
/// `lips_taken` and `contact`. A stopped utterance fades out beneath the next one. Lifetime: the
/// references given to the constructor outlive this. Commands come in order of time; queries are
/// for the time of the last command or later.
class SpeechMotion : public MotionSource {
 public:
  explicit SpeechMotion(const MotionInputs& in);

  /// Starts an utterance whose voice starts at `start`; the mouth begins up to 92 ms before that,
  /// and leads the voice by MotionSettings::lead_ms. `text`: the spoken text, if known; TextCues
  /// derives looks from it.
  void Start(vm::Time now, const vm::PhonemeList& phonemes, vm::Time start,
             std::string_view text = {});
  /// Stops the utterance; the lips are closed 110 ms later.
  void Stop(vm::Time now);
  /// Takes a report that the voice is at `voice_ms` now; ignored when nothing is spoken.
  void Sync(vm::Time now, double voice_ms);
  /// Changes by how many ms the mouth leads the voice, without a jump.
  void MoveLead(vm::Time now, double lead_ms);

  /// Returns the phonemes that no table has, once each: the mouth closes on them.
  std::vector<std::string> UnknownPhonemes(const vm::PhonemeList& phonemes) const {
    return MakeVisemeTargets(phonemes, tables_, settings_.lips).unknown;
  }

  bool active() const { return !utterances_.empty() && !utterances_.back().stopped; }
  /// Returns when the current utterance will be over, for voice and mouth; none if there is none.
  std::optional<vm::Time> End() const;
  double VoicePositionAt(vm::Time t) const;        ///< 0 if nothing is spoken
  const std::string& PhonemeAt(vm::Time t) const;  ///< the phoneme that the mouth shows; "" = none

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextMotion(vm::Time t) const override;

 private:
  struct Utterance {
    std::shared_ptr<const VisemeTrack> track;
    SpeechGestures gestures;
    std::vector<TimedLook> looks;
    SpeechClock clock;
    vm::Time begin;
    std::optional<vm::Time> stopped;
  };
  struct Mouth : SpokenMouth {
    double emotion_reduction = 0;  // how far emotion is reduced; changes more slowly than `weight`
  };
  Mouth MouthAt(vm::Time t) const;
  void MoveHeadAndBrows(vm::Time t, MotionLayer& layer) const;
  void ShowLooks(vm::Time t, MotionLayer& layer) const;
  void AvertEyes(vm::Time t, MotionLayer& layer) const;
  double BlinkAt(vm::Time t) const;
  /// Returns the remaining weight of an utterance's gestures, which fade once it is stopped; 0
  /// outside it.
  double GesturesOf(const Utterance& utterance, vm::Time t) const;
  vm::Time EndOf(const Utterance& utterance) const;
  vm::Time FadedAt(const Utterance& utterance) const;
  double MouthPosition(const Utterance& utterance, vm::Time t) const;

  const MotionTables& tables_;
  const MotionSettings& settings_;
  const Track<float>& mouth_scale_;
  const IdleSwitches& switches_;
  std::uint64_t seed_;
  std::int64_t utterance_count_ = 0;
  std::vector<Utterance> utterances_;
  Track<float> lead_ms_{static_cast<float>(MotionSettings{}.lead_ms)};
};

}  // namespace fsm
