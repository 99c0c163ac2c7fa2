// What a model's endpoint sends: events, chunks of JSON, errors. However it is cut, the words are
// the same.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "chat/model/reply_reader.h"
#include "vm_protocol/http/answer.h"

namespace {

struct Outcome {
  std::string words;
  bool failed = false;
  std::vector<chat::ToolCall> calls;
  bool operator==(const Outcome&) const = default;
};

Outcome Read(std::string_view bytes, std::size_t piece, bool streams) {
  chat::ReplyReader reader(streams);
  Outcome outcome;
  while (!bytes.empty() && !outcome.failed) {
    const std::size_t size = piece < bytes.size() ? piece : bytes.size();
    outcome.failed = !reader.Feed(bytes.substr(0, size), outcome.words);
    bytes.remove_prefix(size);
  }
  if (!outcome.failed) outcome.failed = !reader.End(outcome.words);
  outcome.calls = reader.tool_calls();
  return outcome;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (Read(bytes, size + 1, true) != Read(bytes, 3, true)) std::abort();
  if (Read(bytes, size + 1, false) != Read(bytes, 7, false)) std::abort();
  vm::ErrorTextOf(bytes);
  return 0;
}
