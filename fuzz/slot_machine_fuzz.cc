// Any sequence of lines: every tagged request is answered at most once with that tag as its end,
// and everything said can be read back.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vm_protocol/core/slot_machine.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vm::SlotMachine slots("M");
  slots.set_output([](vm::PeerId, const vm::Message& message) {
    if (vm::ParseMessage(vm::FormatMessage(message)) != message) std::abort();
  });
  slots.set_read_file(
      [](const std::string&) -> vm::Result<std::string> { return "set A = 1\ndo m\n"; });
  slots.Declare({.name = "A", .grammar = "<number 0..9>", .initial = "1", .auto_output = true});
  slots.Declare(
      {.name = "B", .grammar = "ON | OFF", .access = vm::Access::kWriteOnly, .group = {"A"}});
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    slots.HandleLine(rest.substr(0, end), 1);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return 0;
}
