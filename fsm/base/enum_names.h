#pragma once

#include <string_view>

namespace fsm {

/// Returns the name of an enumerator, taken from the compiler's text of this function, which has
/// "kValue = fsm::Bone::kJaw]"; "" for a number without a name: "kValue = (fsm::Bone)9]".
template <auto kValue>
consteval std::string_view NameOf() {
  constexpr std::string_view kBefore = "kValue = ";
  std::string_view text = __PRETTY_FUNCTION__;
  text.remove_prefix(text.find(kBefore) + kBefore.size());
  text = text.substr(0, text.find_first_of(";]"));
  return text.starts_with('(') ? "" : text.substr(text.rfind(':') + 1);
}

/// The number of values of an enumeration that starts at 0, has no gaps, and is scoped or states
/// its type.
template <typename E, int kFrom = 0>
inline constexpr int kValuesOf = kFrom;
template <typename E, int kFrom>
requires(!NameOf<static_cast<E>(kFrom)>().empty()) inline constexpr int kValuesOf<E, kFrom> =
    kValuesOf<E, kFrom + 1>;

}  // namespace fsm
