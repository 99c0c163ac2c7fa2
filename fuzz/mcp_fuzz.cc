// What clients of mcp say, and what modules say of their slots: each message is answered at most
// once, and only valid lines reach a module.

#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "gateway/mcp/mcp_server.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = text.find('\n');
  const std::string said(text.substr(0, cut));
  const std::string module(cut == std::string_view::npos ? "" : text.substr(cut + 1));
  int answers = 0;
  gateway::McpServer server({{"M", "*"}},
                            {.ask = [&](const vm::Message& message, const auto& on_answer) {
                              if (!vm::IsValid(message)) std::abort();
                              on_answer(message.slot == "Slots" ? "A B.c" : module);
                              return gateway::McpServer::GiveUp([] {});
                            }});
  const auto say = [&](const std::string& answer) {
    ++answers;
    if (!nlohmann::json::accept(answer)) std::abort();
  };
  const bool asks = server.Handle(said, say) != nullptr;
  if (answers != (asks ? 1 : 0) || server.running() != 0) std::abort();
  server.Handle(R"({"jsonrpc": "2.0", "id": 1, "method": "tools/list"})", say);
  return 0;
}
