#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "chat/text/tag_table.h"

namespace chat {

/// A sentence to be spoken, and what happens at its beginning and within it.
struct Sentence {
  std::string text;  ///< without line ends, trimmed; empty: only what happens
  std::vector<Cue> before;
  struct Placed {
    std::size_t at = 0;  ///< before this byte of the text
    Cue cue;
  };
  std::vector<Placed> within;

  /// There is something to pronounce.
  bool HasWords() const;
};

/// Words that end with a full stop within a sentence ("Mr.", "e.g."), one of a line of the table
/// tables/abbreviations.txt, without their last full stop, in lower case.
using Abbreviations = std::set<std::string, std::less<>>;
Abbreviations ParseAbbreviations(std::string_view table);

/// Cuts a text that comes in pieces into sentences of English and Japanese and others that end
/// them alike. A sentence ends at . ! ? … before a blank, if what follows may begin one: not after
/// abbreviations, initials and the numbers of a list, nor before a small letter; at 。！？ outside
/// of Japanese quotes; and at the end of a line. Closing quotes and brackets belong to what they
/// close. Signs that cannot be spoken are left out: Markdown's stars, hashes and dashes, emoji,
/// control characters; `<` and `>` become blanks. Limits: kMaxSentenceBytes, then it is cut at a
/// comma, a blank, or a sign.
class SentenceCutter {
 public:
  static constexpr std::size_t kMaxSentenceBytes = 400;
  explicit SentenceCutter(const Abbreviations& abbreviations) : abbreviations_(abbreviations) {}

  void Feed(std::string_view text);
  /// Happens where the text stands now.
  void Mark(Cue cue);
  /// The sentences that are complete.
  std::vector<Sentence> Take() { return TakeUpTo(false); }
  /// The same, and the rest, as the text is at its end.
  std::vector<Sentence> Flush();
  /// What is held back would be a sentence if nothing followed: it waits only to see that.
  bool WouldEnd() const;

 private:
  std::vector<Sentence> TakeUpTo(bool final);
  std::size_t FindEnd(bool final) const;
  bool EndsLatin(std::size_t stop, std::size_t after, bool final, bool& wait) const;
  bool IsAbbreviated(std::size_t stop) const;
  Sentence CutOff(std::size_t end);
  void AddSign(char32_t sign);

  const Abbreviations& abbreviations_;
  std::string text_;  // plain, not cut off yet
  std::vector<Sentence::Placed> marks_;
  bool line_start_ = true;  // only what Markdown puts there has come of this line
  bool dash_ = false;       // and a dash, held back
};

}  // namespace chat
