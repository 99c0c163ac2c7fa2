#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/phonemes.h"
#include "vm_protocol/core/result.h"

namespace ssm {

/// How an engine's phoneme names become those of a language's set, read from a table (ssm/tables):
///     set a i u ...         the names of the set; may be repeated
///     pause pau             the set's name for silence, and the engine's empty name
///     double cl             (optional) of a consonant said twice, what the first becomes
///     doubled n N           (optional) the same for one consonant
///     vowels a i u          (optional) names that `double` leaves alone
///     NAME = A [B...]       the engine's name, and what it is; its time is shared equally
///     NAME = +y             joins the one before: k +y is ky, if the set has that name
///     NAME = -              is dropped; its time goes to the one before
///     * = ax                any other name
/// A name that is not in the table is looked up without its last characters (accents, length).
class PhonemeMap {
 public:
  /// `file` is named in errors: "FILE:LINE: what was found, what was expected" (kSyntax,
  /// kBadValue).
  static vm::Result<PhonemeMap> Parse(std::string_view table, const std::string& file);

  /// Neighbouring pauses become one. The sum of the durations does not change.
  vm::PhonemeList Map(const vm::PhonemeList& engine) const;
  const std::vector<std::string>& set() const { return set_; }
  const std::string& pause() const { return pause_; }

 private:
  const std::vector<std::string>& Find(std::string_view name) const;
  bool InSet(std::string_view name) const;
  void Add(vm::PhonemeList& list, const vm::Phoneme& phoneme) const;

  std::vector<std::string> set_;
  std::vector<std::string> vowels_;
  std::string pause_ = "pau";
  std::string double_;
  std::map<std::string, std::string, std::less<>> doubled_;
  std::map<std::string, std::vector<std::string>, std::less<>> names_;
};

}  // namespace ssm
