// Any value against grammars of every shape: an answer, in bounded time, with its column in range.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vm_protocol/core/value_grammar.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const vm::ValueGrammar kGrammars[] = {
      vm::ValueGrammar("NOW | STOP | <time>"),
      vm::ValueGrammar("( HAPPY | SAD ) <int 1..5> <number 0..200> <ms> | NEUTRAL"),
      vm::ValueGrammar("( <word> <number 0..2> )... [ <ms> ]"),
      vm::ValueGrammar("[ <word> ] [ <word> ] [ <word> ] <number>"),
      vm::ValueGrammar("<file>"),
      vm::ValueGrammar("<text>"),
  };
  if (size == 0) return 0;
  const std::string_view value(reinterpret_cast<const char*>(data + 1), size - 1);
  const auto items = kGrammars[data[0] % std::size(kGrammars)].Match(value);
  if (!items && items.error().column > value.size() + 1) std::abort();
  return 0;
}
