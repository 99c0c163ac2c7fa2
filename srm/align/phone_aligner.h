#pragma once

#include <memory>
#include <string>
#include <vector>

#include "srm/engine/decoder.h"
#include "vm_protocol/core/phonemes.h"

namespace srm {

/// Phonemes of a recording with their times.
struct Alignment {
  vm::PhonemeList phonemes{};  ///< flite's names (ah for every neutral vowel), pau; from 0 on
  std::vector<HeardWord> words{};
};

/// Finds when each phoneme of a recording whose text is known is spoken: the pronunciations of the
/// dictionary, or letter-to-sound rules, one after the other, silences between where there are
/// some. Times are multiples of 10 ms.
/// Thread: one. Errors: kUnavailable (no model), kBadValue (nothing in the text can be said; the
/// text does not fit the sound at all).
class PhoneAligner {
 public:
  static vm::Result<std::unique_ptr<PhoneAligner>> Open(const std::string& model);
  ~PhoneAligner();
  vm::Result<Alignment> Align(const std::vector<std::int16_t>& samples, const std::string& text);

 private:
  struct Parts;
  explicit PhoneAligner(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// "json", "pho" (name[ms] ...), "tsv" (start ms, end ms, kind, name), "textgrid" (Praat).
/// Error: kBadValue naming the four.
vm::Result<std::string> FormatAlignment(const Alignment& alignment, const std::string& format);

}  // namespace srm
