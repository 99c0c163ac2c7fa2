#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "chat/model/sse_reader.h"
#include "vm_protocol/core/result.h"

namespace chat {

/// What the model asks to have done.
struct ToolCall {
  std::string id;
  std::string name;
  std::string arguments;  ///< JSON as the model wrote it

  bool operator==(const ToolCall&) const = default;
};

/// Reads the answer to POST /v1/chat/completions: a stream of chunks, or, from a server that does
/// not stream, one completion. Pure.
/// Limits: kMaxToolCalls, kMaxArgumentBytes of each.
class ReplyReader {
 public:
  static constexpr std::size_t kMaxToolCalls = 16;
  static constexpr std::size_t kMaxArgumentBytes = 16 << 10;

  /// `streams`: the answer is a stream of events.
  explicit ReplyReader(bool streams) : streams_(streams) {}
  /// Adds the words that have come to `words`, also those before an error. Errors: kSyntax (no
  /// JSON, or none of this kind), kTooLong, kUnavailable (the endpoint reports an error in the
  /// stream).
  vm::Result<void> Feed(std::string_view bytes, std::string& words);
  /// At the end: the words of an answer that was no stream. kUnavailable if it broke off.
  vm::Result<void> End(std::string& words);
  /// The model has said that it is done; what may follow does not matter.
  bool complete() const { return complete_; }
  const std::vector<ToolCall>& tool_calls() const { return tool_calls_; }

 private:
  vm::Result<std::string> ReadEvent(const std::string& event);

  const bool streams_;
  SseReader events_;
  std::string body_;  // of what is no stream
  bool complete_ = false;
  bool finished_ = false;  // a reason to finish has come
  std::vector<ToolCall> tool_calls_;
};

}  // namespace chat
