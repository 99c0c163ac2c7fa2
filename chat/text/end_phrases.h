#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chat {

/// Phrases by which somebody ends a conversation: "that is all | back to the menu". Case, signs
/// between words and blanks do not count; a phrase is found wherever its words stand together.
/// Between Japanese words there are no blanks, so phrases that are not ASCII may stand within a
/// word. Thread: constant after construction. Limits: kMaxPhrases, the rest is left out.
class EndPhrases {
 public:
  static constexpr std::size_t kMaxPhrases = 32;

  EndPhrases() = default;
  explicit EndPhrases(std::string_view text);
  bool FoundIn(std::string_view heard) const;

 private:
  std::vector<std::string> phrases_;  ///< as Plain() writes them
};

}  // namespace chat
