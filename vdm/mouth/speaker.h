#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

/// What is known of somebody's voice beforehand.
struct Speaker {
  float warp = 1;  ///< of the vocal tract, for MakeFeatures
};
/// The text of a speaker's file: `warp NUMBER`, `#` begins a comment. Error: kBadValue "NAME:LINE:
/// ...".
vm::Result<Speaker> ParseSpeaker(const std::string& name, std::string_view text);
std::string FormatSpeaker(const Speaker& speaker);

/// How a new speaker is met; tables/vowels.txt.
struct VowelTable {
  std::vector<std::string> vowels;  ///< classes of sounds, in the order in which they are said
  std::vector<float> warps;         ///< rising, 0.5 .. 1.5
};
/// kBadValue "NAME:LINE: ...".
vm::Result<VowelTable> ReadVowels(const std::string& name, std::string_view text);
const VowelTable& BuiltVowels();

/// Speakers by name: those of this process and, if it has a folder, those kept there as
/// NAME.speaker. Names are 1 to 40 letters, digits, - and _, so no other file is ever touched.
class SpeakerStore {
 public:
  explicit SpeakerStore(std::string folder = {}) : folder_(std::move(folder)) {}
  static bool IsName(std::string_view name);
  /// Errors: kBadValue (no such name, a damaged file), kUnavailable (nobody of that name).
  vm::Result<Speaker> Find(const std::string& name) const;
  /// A speaker of the same name is replaced. Errors: kBadValue, kUnavailable (cannot be written,
  /// more than kMost speakers without a folder).
  vm::Result<void> Keep(const std::string& name, const Speaker& speaker);
  static constexpr std::size_t kMost = 1000;

 private:
  std::string PathOf(const std::string& name) const { return folder_ + "/" + name + ".speaker"; }
  const std::string folder_;
  std::map<std::string, Speaker> here_;  // without a folder
};

}  // namespace vdm
