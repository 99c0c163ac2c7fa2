// The hub's configuration: modules, rules, rights, limits.

#include <cstdint>
#include <string_view>

#include "agent_manager/config/config.h"
#include "agent_manager/routing/rules.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto config = am::ParseConfig(text, "fuzz.json", "/nonexistent");
  if (!config) return 0;
  am::Rules rules;
  rules.set_rules(std::move(config->rules));
  for (const char* line : {"set Text = hello", "rep X = 1", "tell 10", "set A < file"}) {
    auto message = vm::ParseMessage(line);
    std::string to = "SSM";
    static_cast<void>(rules.Apply({"A", "", am::Role::kGuest}, to, *message, vm::Time(1)));
  }
  return 0;
}
