#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace vm {

/// One phoneme and how long it lasts. Names are the engine's (flite: ax hh pau; Japanese: a k sil).
struct Phoneme {
  std::string name;
  std::chrono::milliseconds duration{0};

  bool operator==(const Phoneme&) const = default;
};
using PhonemeList = std::vector<Phoneme>;

/// Reads every spelling in use: `a[80] k[60]`, `a [80] k [60]`, `a 80 k 60`, mixed; the closing
/// word `phoneme_end` of the original's socket mode is accepted and dropped.
/// Durations are decimal ms from 0 to 60000, rounded to whole ms. At most kMaxPhonemes.
/// Errors: kBadValue with the column within `text`, kLimit.
Result<PhonemeList> ParsePhonemes(std::string_view text);

std::string FormatPhonemesVoice(const PhonemeList& list);  ///< `sil[10] k[60]`   (voice module)
std::string FormatPhonemesFace(const PhonemeList& list);   ///< `sil [10] k [60] ` (face module)
std::string FormatPhonemesPlain(const PhonemeList& list);  ///< `sil 10 k 60`     (LipSync.pho)

std::chrono::milliseconds TotalDuration(const PhonemeList& list);
/// The beginning of the list, up to `spoken`; the last item is cut to what was heard of it.
PhonemeList SpokenPart(const PhonemeList& list, std::chrono::milliseconds spoken);

}  // namespace vm
