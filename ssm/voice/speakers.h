#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/speech_engine.h"
#include "vm_protocol/core/result.h"

namespace ssm {

/// A name for one of the engine's voices, by which programs may ask for it.
struct SpeakerAlias {
  std::string name{};
  bool female = false;
};

/// The names of the original voice module; programs written for it set them unasked.
std::vector<SpeakerAlias> OriginalSpeakers();

/// All the names `Speaker` takes: the engine's own, then the aliases. An alias stands for the
/// first voice of its sex that no earlier alias has, or for the first of its sex, or for the first.
class SpeakerTable {
 public:
  SpeakerTable(const std::vector<VoiceInfo>& voices, const std::vector<SpeakerAlias>& aliases);
  /// The voice meant by a name of the table; null for any other.
  const VoiceInfo* Find(std::string_view name) const;
  /// The same with an error that says which names there are.
  vm::Result<const VoiceInfo*> Wanted(std::string_view name) const;
  /// The names of listed voices and the aliases, separated by blanks: the value of SpeakerSet.
  std::string Names() const;
  /// With those voices that are not listed.
  std::string AllNames() const;

 private:
  struct Entry {
    std::string name;
    VoiceInfo voice;
  };
  std::vector<Entry> entries_;
};

}  // namespace ssm
