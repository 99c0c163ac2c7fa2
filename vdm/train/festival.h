#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vdm/train/corpus.h"
#include "vdm/train/reading.h"

namespace vdm {

/// What festival's voices of a language expect and say; tables/festival_phones.txt.
struct FestivalLanguage {
  std::string charset;                                     ///< as iconv names it
  std::map<std::string, std::string, std::less<>> phones;  ///< theirs to ours
};
using FestivalLanguages = std::map<std::string, FestivalLanguage, std::less<>>;
/// kBadValue "NAME:LINE: ...".
vm::Result<FestivalLanguages> ReadFestivalPhones(const std::string& name, std::string_view text);
const FestivalLanguages& BuiltFestivalPhones();

/// The segments of a file of festival (utt.save.segs: a line "#", then END_S COLOUR PHONE) as
/// phonemes of ours. kBadValue "NAME:LINE: ...", also for a phone that the language does not name.
vm::Result<vm::PhonemeList> ReadSegments(const std::string& name, std::string_view text,
                                         const FestivalLanguage& language);

/// Has a voice of festival read texts (UTF-8) in a process of its own, at most ten minutes of it;
/// `folder` holds its files meanwhile. Errors: kUnavailable (festival or the voice is missing, or
/// it fails), kBadValue (what it gives).
vm::Result<std::vector<Take>> ReadByFestival(const TrainingVoice& voice,
                                             const std::vector<std::string>& texts,
                                             const std::string& folder);

}  // namespace vdm
