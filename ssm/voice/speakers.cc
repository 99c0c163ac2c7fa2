#include "ssm/voice/speakers.h"

#include <algorithm>
#include <cassert>

#include "vm_protocol/core/nearest_word.h"

namespace ssm {

std::vector<SpeakerAlias> OriginalSpeakers() {
  return {{"male01", false}, {"female01", true}, {"male02", false}};
}

SpeakerTable::SpeakerTable(const std::vector<VoiceInfo>& voices,
                           const std::vector<SpeakerAlias>& aliases) {
  assert(!voices.empty());
  for (const VoiceInfo& voice : voices) entries_.push_back({voice.name, voice});
  std::vector<std::string> taken;
  for (const SpeakerAlias& alias : aliases) {
    if (Find(alias.name) != nullptr) continue;
    const VoiceInfo* chosen = nullptr;
    for (const VoiceInfo& voice : voices) {
      if (voice.female != alias.female || !voice.listed) continue;
      const bool is_taken = std::find(taken.begin(), taken.end(), voice.name) != taken.end();
      if (chosen == nullptr || !is_taken) chosen = &voice;
      if (!is_taken) break;
    }
    if (chosen == nullptr) chosen = &voices.front();
    taken.push_back(chosen->name);
    entries_.push_back({alias.name, *chosen});
  }
}

const VoiceInfo* SpeakerTable::Find(std::string_view name) const {
  for (const Entry& entry : entries_) {
    if (entry.name == name) return &entry.voice;
  }
  return nullptr;
}

vm::Result<const VoiceInfo*> SpeakerTable::Wanted(std::string_view name) const {
  if (const VoiceInfo* found = Find(name)) return found;
  std::vector<std::string> known;
  for (const Entry& entry : entries_) known.push_back(entry.name);
  std::string more;
  const auto unlisted = [](const Entry& entry) { return !entry.voice.listed; };
  if (const auto count = std::ranges::count_if(entries_, unlisted); count > 0) {
    more = ", or one of " + std::to_string(count) + " more such as " +
           std::ranges::find_if(entries_, unlisted)->name + " (inq Speaker.all names them)";
  }
  return vm::Fail(vm::Errc::kBadValue, "unknown speaker '" + std::string(name) +
                                           "', expected one of: " + Names() + more +
                                           vm::DidYouMean(name, known));
}

std::string SpeakerTable::Names() const {
  std::string names;
  for (const Entry& entry : entries_) {
    if (entry.voice.listed) names += (names.empty() ? "" : " ") + entry.name;
  }
  return names;
}

std::string SpeakerTable::AllNames() const {
  std::string names;
  for (const Entry& entry : entries_) names += (names.empty() ? "" : " ") + entry.name;
  return names;
}

}  // namespace ssm
