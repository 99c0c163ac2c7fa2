#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "ssm/voice/speech_engine.h"

namespace ssm {

/// What is laid over an engine's speech, by places in its text (bytes of `text`).
struct Layers {
  /// A mark, or a pause where `mark` is empty.
  struct Event {
    std::size_t at = 0;
    std::string mark{};
    Millis pause{0};
  };
  /// A manner relative to the engine's own there.
  struct Manner {
    std::size_t begin = 0, end = 0;
    double stretch = 1, pitch = 1, volume = 1;
    Intonation intonation{};
    Millis lasts{0};
    unsigned element = 0;
    bool plain() const;  ///< it changes nothing
  };
  std::vector<SpeechSpan> spans{};  ///< what the engine gets
  std::string text{};               ///< of the spans, as it is written
  std::vector<Event> events{};      ///< in order
  std::vector<Manner> manners{};    ///< in order, none over another
};

/// Parts what markup says into what the engine has to know and what is laid over it.
Layers PartLayers(const std::vector<SpeechSpan>& spans);

/// A part of the engine's sound and what becomes of it.
struct SoundPart {
  Millis from{0}, to{0};  ///< of the engine's sound; equal: silence
  Millis length{0};       ///< what it becomes
  double pitch = 1, volume = 1;
  Intonation intonation{};
  /// Where in its element's time it begins and ends, for the contour.
  double begin01 = 0, end01 = 1;
  bool plain() const;  ///< as the engine made it
};

/// The engine's plan with the layers over it; the detail is not touched. `parts` gets what becomes
/// of its sound, from front to end; none if all of it stays.
SpeechPlan LayOver(const Layers& layers, const SpeechPlan& plan, std::vector<SoundPart>& parts);

/// The engine's sound made into what `parts` say.
std::vector<std::int16_t> MakeSound(std::span<const std::int16_t> sound,
                                    const std::vector<SoundPart>& parts);

}  // namespace ssm
