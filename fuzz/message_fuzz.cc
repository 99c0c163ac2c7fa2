// Whatever ParseMessage accepts must be valid and survive being written and read again; whatever it
// refuses must come with a column inside the line.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vm_protocol/core/message.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const auto message = vm::ParseMessage(line);
  if (!message) {
    if (message.error().column > size + 1) std::abort();
    return 0;
  }
  if (!vm::IsValid(*message)) {
    // The one way to be read but not written: the canonical form is longer than the loose one.
    if (vm::FormatMessage(*message).size() <= size) std::abort();
    return 0;
  }
  if (vm::ParseMessage(vm::FormatMessage(*message)) != message) std::abort();
  return 0;
}
