#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vdm/train/corpus.h"

namespace vdm {

/// Recordings of people with what they say: a line of the list is FILE, LANGUAGE and TEXT between
/// tabs (FILE beside the list, any format that libsndfile reads; LANGUAGE of
/// ssm/tables/espeak_voices.txt). espeak-ng says which phonemes the text has, AlignPhonemes when
/// they are spoken. The voice of a take is "people-LANGUAGE". Recordings that do not fit their text
/// are left out; `progress` is told how many. Errors: kUnavailable (a file, or espeak-ng),
/// kBadValue "LIST:LINE: ...", and where
/// none fits.
vm::Result<std::vector<Take>> ReadPeople(const std::string& list, const std::string& espeak_helper,
                                         const std::function<void(const std::string&)>& progress);

}  // namespace vdm
