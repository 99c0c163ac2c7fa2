// Scripts under their limits, the rewriter that counts them, and regular expressions.
#include <cstddef>
#include <cstdint>
#include <string>

#include "task_manager/script/engine.h"
#include "task_manager/script/regexps.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  vxml::script::Limits limits;
  limits.steps = 2000;
  limits.heap_bytes = std::size_t{4} << 20;
  limits.time = std::chrono::milliseconds(200);
  static vxml::script::Engine engine(limits);
  const vxml::script::Chain chain{engine.NewScope()};
  static_cast<void>(engine.Run(chain, text));
  static_cast<void>(engine.Evaluate(chain, text));
  vxml::script::Regexps regexps;
  vxml::script::Regexps::Spans spans;
  static_cast<void>(regexps.Match(text, "im", U"The quick brown fox, 12345 aaaaaaaa", 0, spans));
  return 0;
}
