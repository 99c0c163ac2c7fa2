#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "srm/engine/decoder.h"

namespace srm {

/// Turns whole utterances into words, elsewhere, which takes its time.
/// Thread: the scheduler's.
class Transcriber {
 public:
  using Done = std::function<void(const vm::Result<Hypothesis>& heard)>;
  virtual ~Transcriber() = default;
  /// Calls `done` once, later, in the order of the utterances; never after Abandon or the end of
  /// this object. An empty text: nothing was said. kLimit at once: too many are waiting.
  virtual vm::Result<void> Transcribe(std::span<const std::int16_t> sound, Done done) = 0;
  virtual bool Busy() const = 0;
  /// Drops what is going on and what waits.
  virtual void Abandon() = 0;
};

/// The decoder beside a transcriber: it hears nothing, so that the sound is only cut.
std::unique_ptr<SpeechDecoder> MakeDeafDecoder();

}  // namespace srm
