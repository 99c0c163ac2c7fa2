#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace ssm {

/// A word of a Japanese text with its reading.
struct JapaneseWord {
  std::string text{};  ///< as written
  std::string kana{};  ///< katakana as spoken (は as a particle: ワ); "、" or "。" for a pause
  bool operator==(const JapaneseWord&) const = default;
};

/// Finds the readings of Japanese text by MeCab and a dictionary with readings (naist-jdic,
/// ipadic), after our own normaliser. About 0.3 ms a sentence. Thread: one call at a time. Errors:
/// kUnavailable with a sentence.
class JapaneseReader {
 public:
  /// `dictionary`: a folder; empty = the first found where Debian puts them.
  static vm::Result<std::unique_ptr<JapaneseReader>> Open(const std::string& dictionary);
  ~JapaneseReader();
  JapaneseReader(const JapaneseReader&) = delete;

  /// `unread`: words for which there is no reading (rare kanji); they are left out.
  std::vector<JapaneseWord> Read(std::string_view text, std::string& unread);

 private:
  struct Parts;
  explicit JapaneseReader(std::unique_ptr<Parts> parts);
  std::vector<JapaneseWord> Analyse(const std::string& text, std::string& unread);
  std::unique_ptr<Parts> parts_;
};

/// The dictionaries looked for, best first.
std::vector<std::string> KnownDictionaries();

}  // namespace ssm
