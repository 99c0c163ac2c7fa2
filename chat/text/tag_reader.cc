#include "chat/text/tag_reader.h"

#include <algorithm>

#include "vm_protocol/core/blanks.h"
#include "vm_protocol/core/lower_case.h"

namespace chat {
namespace {

bool IsLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Where the bracket at the beginning of `text` is closed; npos: not within it.
std::size_t CloseOf(std::string_view text) {
  const char close = text[0] == '<' ? '>' : ']';
  char quote = 0;
  for (std::size_t i = 1; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') return std::string_view::npos;
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (text[0] == '<' && (c == '"' || c == '\'') && text[i - 1] == '=') {
      quote = c;
    } else if (c == close) {
      return i;
    }
  }
  return std::string_view::npos;
}

/// Takes a word off the beginning: up to a blank, a comma or `=`, or what is within quotes.
std::string TakeWord(std::string_view& text) {
  if (!text.empty() && (text[0] == '"' || text[0] == '\'')) {
    const std::size_t end = std::min(text.find(text[0], 1), text.size());
    const std::string word(text.substr(1, end - 1));
    text.remove_prefix(std::min(end + 1, text.size()));
    return word;
  }
  const std::size_t end = std::min(text.find_first_of(" \t,=:"), text.size());
  const std::string word(text.substr(0, end));
  text.remove_prefix(end);
  return word;
}

}  // namespace

Tag ParseTag(std::string_view inside) {
  if (inside.ends_with('/')) inside.remove_suffix(1);
  Tag tag;
  tag.name = vm::LowerCase(TakeWord(inside));
  while (true) {
    inside.remove_prefix(std::min(inside.find_first_not_of(" \t,=:"), inside.size()));
    if (inside.empty()) return tag;
    std::string word = TakeWord(inside);
    if (inside.starts_with('=')) {
      inside.remove_prefix(1);
      tag.values.emplace_back(vm::LowerCase(word), TakeWord(inside));
    } else {
      tag.values.emplace_back("", std::move(word));
    }
  }
}

std::vector<TagReader::Item> TagReader::Feed(std::string_view text) {
  held_ += text;
  return Read(false);
}

std::vector<TagReader::Item> TagReader::Flush() {
  auto items = Read(true);
  silent_.clear();
  return items;
}

void TagReader::AddText(std::string_view text, std::vector<Item>& items) {
  if (text.empty() || !silent_.empty()) return;
  if (!items.empty() && std::holds_alternative<std::string>(items.back())) {
    std::get<std::string>(items.back()) += text;
  } else {
    items.emplace_back(std::string(text));
  }
}

void TagReader::TakeTag(std::string_view inside, std::vector<Item>& items) {
  const Tag tag = ParseTag(inside);
  if (!silent_.empty()) {
    if (tag.name == "/" + silent_) silent_.clear();
    return;
  }
  if (table_.IsSilent(tag.name)) {
    if (!inside.ends_with('/')) silent_ = tag.name;
    return;
  }
  if (auto cue = table_.CueOf(tag)) items.emplace_back(std::move(*cue));
}

/// `end` is where the `]` stands.
TagReader::Taken TagReader::TakeLink(std::size_t end, bool final, std::vector<Item>& items) {
  const std::size_t close = held_.find_first_of(")\n", end + 1);
  if (close == std::string::npos && !final && held_.size() - end < kMaxTagBytes)
    return Taken::kWait;
  AddText(std::string_view(held_).substr(1, end - 1), items);
  const bool closed = close != std::string::npos && held_[close] == ')';
  held_.erase(0, closed ? close + 1 : end + 1);
  return Taken::kOne;
}

/// What is held begins with a bracket.
TagReader::Taken TagReader::TakeBracket(bool final, std::vector<Item>& items) {
  const std::string_view held = held_;
  if (held.size() == 1 && !final) return Taken::kWait;
  const char second = held.size() > 1 ? held[1] : ' ';
  const bool angle = held[0] == '<';
  if (IsLetter(second) || second == '/' || (angle ? second == '!' : IsDigit(second))) {
    const std::size_t end = CloseOf(held.substr(0, kMaxTagBytes));
    if (end == std::string_view::npos) {
      const bool broken = held.substr(0, kMaxTagBytes).contains('\n');
      if (!final && !broken && held.size() < kMaxTagBytes) return Taken::kWait;
    } else {
      const std::string inside(vm::Trimmed(held.substr(1, end - 1)));
      if (!angle && silent_.empty() && !table_.Knows(ParseTag(inside).name)) {
        if (held.size() == end + 1 && !final) return Taken::kWait;  // a link may follow
        if (held.substr(end + 1).starts_with('(')) return TakeLink(end, final, items);
      }
      held_.erase(0, end + 1);
      TakeTag(inside, items);
      return Taken::kOne;
    }
  }
  AddText(held.substr(0, 1), items);
  held_.erase(0, 1);
  return Taken::kOne;
}

std::vector<TagReader::Item> TagReader::Read(bool final) {
  std::vector<Item> items;
  while (!held_.empty()) {
    const std::size_t bracket = std::min(held_.find_first_of("<["), held_.size());
    AddText(std::string_view(held_).substr(0, bracket), items);
    held_.erase(0, bracket);
    if (!held_.empty() && TakeBracket(final, items) == Taken::kWait) break;
  }
  return items;
}

}  // namespace chat
