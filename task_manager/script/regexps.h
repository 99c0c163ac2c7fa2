#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vxml::script {

/// A regular expression of ECMA-262 (5th edition, 15.10) in the language of PCRE2, code unit by
/// code unit. What the script engine's own compiler has refused never comes here.
std::u32string TranslatePattern(std::u32string_view source, bool multiline);

/// Matches regular expressions under a limit: the script engine's own matcher can backtrack for
/// half a minute and cannot be interrupted. Texts are sequences of the engine's characters.
/// Differences from ECMA-262: a group keeps what it matched in an earlier turn of a repeat around
/// it. Limits: kMaxBacktracks and kMaxKilobytes of one match, kMaxKept compiled patterns; texts
/// over kMaxTextBytes are refused by the caller. Thread: one instance, one thread.
class Regexps {
 public:
  static constexpr std::uint32_t kMaxBacktracks = 5'000'000;  ///< about 0.3 s of one core
  static constexpr std::uint32_t kMaxKilobytes = 16 * 1024;
  static constexpr std::size_t kMaxKept = 200;
  static constexpr std::size_t kMaxMemoryBytes = std::size_t{32} << 20;  ///< compiled and matching
  static constexpr std::size_t kMaxPatternBytes = std::size_t{16} << 10;
  static constexpr std::size_t kMaxTextBytes = std::size_t{4} << 20;

  enum class Outcome { kMatch, kNoMatch, kOverLimit, kRefused };
  using Spans = std::vector<long>;  ///< begin, end of the match and of each group; -1: not matched

  Regexps();
  ~Regexps();
  Regexps(const Regexps&) = delete;
  Regexps& operator=(const Regexps&) = delete;

  /// `flags`: 'i' and 'm' count. Looks for the first match at or after `from`.
  Outcome Match(std::string_view source, std::string_view flags, std::u32string_view text,
                std::size_t from, Spans& spans);

 private:
  struct Compiled;
  struct Limits;
  const Compiled* Compile(std::string_view source, std::string_view flags);

  std::unique_ptr<Limits> limits_;
  std::map<std::pair<std::string, std::string>, std::unique_ptr<Compiled>> kept_;
};

/// The engine's strings (UTF-8, surrogates as three bytes each) as a sequence of its characters.
std::u32string Characters(std::string_view text);
/// The same as UTF-8: pairs of surrogates joined, half ones U+FFFD.
std::string ToUtf8(std::string_view text);

}  // namespace vxml::script
