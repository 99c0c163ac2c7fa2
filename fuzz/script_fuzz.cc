// Scripts under their limits.
#include <cstddef>
#include <cstdint>
#include <string>

#include "task_manager/script/engine.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  vxml::script::Limits limits;
  limits.heap_bytes = std::size_t{4} << 20;
  limits.time = std::chrono::milliseconds(200);
  static vxml::script::Engine engine(limits);
  const vxml::script::Chain chain{engine.NewScope()};
  static_cast<void>(engine.Run(chain, text));
  static_cast<void>(engine.Evaluate(chain, text));
  static_cast<void>(engine.CheckExpression(text));
  return 0;
}
