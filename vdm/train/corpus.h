#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// One sentence spoken by one voice, with the times of its phonemes.
struct Take {
  std::string voice;
  std::vector<std::int16_t> samples;  ///< 16 kHz mono
  vm::PhonemeList phonemes;           ///< as long as the samples, to some ms
};

/// Has every voice of the table (tables/voices.txt) read its sentences. The same programs say the
/// same in the same order. `espeak_helper`: the path of ssm_espeak; `folder`: for files meanwhile.
/// `progress` is told what is done. Error: that of the engine that fails.
vm::Result<std::vector<Take>> MakeCorpus(const std::string& espeak_helper,
                                         const std::string& folder,
                                         const std::function<void(const std::string&)>& progress);

/// Keeps takes in a file of our own, and brings them back. Errors: kUnavailable, kBadValue with the
/// file's name.
vm::Result<void> SaveCorpus(const std::vector<Take>& takes, const std::string& path);
vm::Result<std::vector<Take>> LoadCorpus(const std::string& path);

}  // namespace vdm
