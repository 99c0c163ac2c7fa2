#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "ssm/engines/piece_engine.h"

namespace ssm {

/// Finds the phonemes of sound whose text is known, by the program `align` (srm/align), which is
/// started at the first job and kept.
/// Thread: one at a time. Errors: kUnavailable, kTimeout (it is killed), kBadValue (its answer).
class Aligner {
 public:
  struct Options {
    std::string program{};  ///< path of align
    std::chrono::milliseconds limit{60'000};
  };
  explicit Aligner(Options options);
  ~Aligner();
  /// Phonemes (flite's names) and words; no samples.
  vm::Result<Piece> Align(const std::string& wav_path, const std::string& text,
                          const std::atomic<bool>& cancelled);

 private:
  struct Job;
  const Options options_;
  std::unique_ptr<class ChildProcess> process_;
};

}  // namespace ssm
