#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "chat/text/tag_table.h"

namespace chat {

/// Takes tags out of a text that comes in pieces, wherever it is cut. `<name ...>` and `[name ...]`
/// are tags; of those the table does not know nothing is left, as of what stands within a silent
/// element. A link of Markdown, `[words](address)`, leaves its words. What begins like a tag and is
/// none (3 < 4, an unclosed bracket) is text.
/// Thread: none of its own. Lifetime: the table outlives it.
/// Limits: kMaxTagBytes for a tag, after which it counts as text.
class TagReader {
 public:
  static constexpr std::size_t kMaxTagBytes = 256;
  using Item = std::variant<std::string, Cue>;  ///< words, or what a tag says to the hub

  explicit TagReader(const TagTable& table) : table_(table) {}
  std::vector<Item> Feed(std::string_view text);
  /// The end of the text: what is held back counts as it stands.
  std::vector<Item> Flush();

 private:
  enum class Taken { kOne, kWait };
  Taken TakeBracket(bool final, std::vector<Item>& items);
  Taken TakeLink(std::size_t end, bool final, std::vector<Item>& items);
  void TakeTag(std::string_view inside, std::vector<Item>& items);
  void AddText(std::string_view text, std::vector<Item>& items);
  std::vector<Item> Read(bool final);

  const TagTable& table_;
  std::string held_;    // not read yet
  std::string silent_;  // within the element of that name; empty: not
};

/// Takes apart what stands between the brackets: `emotion name="HAPPY" strength=60 /`. Pure.
Tag ParseTag(std::string_view inside);

}  // namespace chat
