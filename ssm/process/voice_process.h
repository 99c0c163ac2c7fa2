#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ssm/process/child_process.h"
#include "vm_protocol/core/phonemes.h"

namespace ssm {

/// What a voice made of a text. 16 kHz mono.
struct Spoken {
  std::vector<std::int16_t> samples{};
  vm::PhonemeList phonemes{};
};

/// A voice module (ssm) of our own, spoken to in the protocol over its standard input and output:
/// started when first needed, kept, started anew after it failed. Thread: one.
class VoiceProcess {
 public:
  struct Words {
    std::string text{};   ///< as its slot Text takes it; line breaks are blanks
    std::string voice{};  ///< "" = its first one
    double speed = 1;
  };
  /// `limit` for a text; `cancelled`, which outlives this, ends what is under way.
  VoiceProcess(std::vector<std::string> command, std::chrono::milliseconds limit,
               const std::atomic<bool>* cancelled = nullptr)
      : command_(std::move(command)), limit_(limit), cancelled_(cancelled) {}

  /// Errors: the voice's own (kBadValue: there is no such voice), kUnavailable, kTimeout, kStopped.
  vm::Result<Spoken> Speak(const Words& words);

 private:
  vm::Result<Spoken> SpeakOnce(const Words& words, const std::string& wav);
  /// The value a request is answered with.
  vm::Result<std::string> Request(const std::string& line, const ChildProcess::Wait& wait);

  const std::vector<std::string> command_;
  const std::chrono::milliseconds limit_;
  const std::atomic<bool>* const cancelled_;
  std::unique_ptr<ChildProcess> process_;
  unsigned last_tag_ = 0;
  bool refused_ = false;  // the last error is the voice's own word
  std::string first_voice_;
};

}  // namespace ssm
