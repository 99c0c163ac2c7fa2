#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <glm/vec3.hpp>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "vm_protocol/core/slot_machine.h"

namespace fsm {

/// A word of a slot's grammar and the value it denotes. Lists of them are in the order of the
/// grammar.
template <typename Value>
using SlotWord = std::pair<std::string_view, Value>;

/// Returns the words as "A | B | C".
std::string GrammarOf(const auto& words) {
  std::string grammar;
  for (const auto& [word, value] : words) {
    grammar += (grammar.empty() ? "" : " | ") + std::string(word);
  }
  return grammar;
}

/// Returns the value of a word; nothing if it is not in the list.
auto ValueOf(const auto& words, std::string_view word)
    -> std::optional<decltype(std::begin(words)->second)> {
  const auto found = std::ranges::find(words, word, [](const auto& each) { return each.first; });
  if (found == std::end(words)) return std::nullopt;
  return found->second;
}

/// Returns a number of a slot's value as the state of the face and the scene have it.
inline float RealOf(const vm::SetValue& value, std::size_t index) {
  return static_cast<float>(value.number(index));
}

/// Parses "#rrggbb" to sRGB, 0..1; nothing for other texts.
inline std::optional<glm::vec3> ParseColour(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  unsigned rgb = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, rgb, 16);
  if (error != std::errc{} || end != text.data() + 7) return std::nullopt;
  return glm::vec3(static_cast<float>(rgb >> 16 & 255u), static_cast<float>(rgb >> 8 & 255u),
                   static_cast<float>(rgb & 255u)) /
         255.0f;
}

/// Returns the first word with a value. REQUIRES: there is one.
std::string WordOf(const auto& words, const auto& value) {
  return std::string(
      std::ranges::find(words, value, [](const auto& each) { return each.second; })->first);
}

}  // namespace fsm
