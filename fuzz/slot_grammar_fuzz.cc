// Any grammar from outside and any value for it: the grammar is refused with a column within its
// text, or every value is compared in bounded time and depth. The two are parted by a newline.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vm_protocol/core/value_grammar.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = input.find('\n');
  const std::string_view text = input.substr(0, end);
  const std::string_view value = end == std::string_view::npos ? "" : input.substr(end + 1);
  const auto grammar = vm::ValueGrammar::Parse(text);
  if (!grammar) {
    if (grammar.error().code != vm::Errc::kBadValue || grammar.error().column > text.size() + 1)
      std::abort();
    return 0;
  }
  if (grammar->text() != text) std::abort();
  const auto items = grammar->Match(value);
  if (!items) {
    if (items.error().column > value.size() + 1) std::abort();
    return 0;
  }
  for (const auto& item : *items) {
    if (!item.files.empty() && !grammar->has_file()) std::abort();
  }
  return 0;
}
