// Both forms of grammars: compiled, linked and matched against a piece of the input.
#include <cstddef>
#include <cstdint>
#include <string>

#include "task_manager/grammar/matcher.h"
#include "task_manager/grammar/phrases.h"
#include "task_manager/grammar/store.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  vxml::srgs::GrammarContext context;
  context.uri = "fuzz";
  // Inline grammars may leave the header out, so nothing stands between the input and the parser.
  auto made = bytes.starts_with("<") ? vxml::srgs::CompileBytes(bytes, context)
                                     : vxml::srgs::CompileAbnf(bytes, context);
  if (!made) return 0;
  vxml::srgs::GrammarStore store([](const std::string&) -> vm::Result<std::string> {
    return vm::Fail(vm::Errc::kUnavailable, "nothing is fetched");
  });
  auto linked = store.Add(std::move(*made));
  if (!linked || !(*linked)->RootRule()) return 0;
  static_cast<void>(vxml::srgs::ToPhrases(*(*linked)->RootRule(), 12'000));
  static_cast<void>(vxml::srgs::Match(*(*linked)->RootRule(), bytes.substr(0, 40)));
  return 0;
}
