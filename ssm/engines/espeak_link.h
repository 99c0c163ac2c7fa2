#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ssm/engines/espeak_engine.h"
#include "ssm/process/child_process.h"

namespace ssm {

/// The conversation with the helper program that speaks by espeak-ng; its protocol stands in
/// ssm/espeak_helper/main.cc. Started when first needed, again if it died.
/// Thread: one at a time. Errors: kUnavailable, kTimeout (it is killed).
class EspeakLink {
 public:
  struct Answer {
    std::int64_t rate = 0;
    std::vector<std::int16_t> samples;
    vm::PhonemeList phonemes;  // by espeak-ng's names
    struct Word {
      Millis at{0};
      std::size_t character = 0, count = 0;
    };
    std::vector<Word> words;
  };

  explicit EspeakLink(const EspeakOptions& options) : options_(options) {}
  vm::Result<Answer> Say(const std::string& request, const std::atomic<bool>& cancelled);

 private:
  vm::Result<Answer> TrySay(const std::string& request, const std::atomic<bool>& cancelled);
  vm::Result<Answer> ReadSound(const std::string& head, const ChildProcess::Wait& wait);

  const EspeakOptions options_;
  std::unique_ptr<ChildProcess> process_;
  bool spoke_ = false;  // the last failure was the helper's own word
};

}  // namespace ssm
