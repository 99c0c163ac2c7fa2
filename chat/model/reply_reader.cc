#include "chat/model/reply_reader.h"

#include <nlohmann/json.hpp>

#include "vm_protocol/http/answer.h"

namespace chat {
namespace {

using nlohmann::json;
using vm::Errc;
using vm::Fail;

using vm::ErrorIn;
using vm::TextAt;

/// The words of `content`: a string, or a list of parts with text.
std::string ContentOf(const json& message) {
  const auto found = message.find("content");
  if (found == message.end()) return "";
  if (found->is_string()) return found->get<std::string>();
  std::string text;
  if (!found->is_array()) return text;
  for (const json& part : *found) {
    if (part.is_object()) text += TextAt(part, "text");
  }
  return text;
}

/// Adds the pieces of tool calls that `message` has.
vm::Result<void> AddToolCalls(const json& message, std::vector<ToolCall>& calls) {
  const auto found = message.find("tool_calls");
  if (found == message.end() || !found->is_array()) return {};
  for (std::size_t i = 0; i < found->size(); ++i) {
    const json& piece = (*found)[i];
    if (!piece.is_object()) continue;
    const auto at = piece.find("index");
    const std::size_t index =
        at != piece.end() && at->is_number_unsigned() ? at->get<std::size_t>() : i;
    if (index >= ReplyReader::kMaxToolCalls) {
      return Fail(Errc::kTooLong, "the model calls more than " +
                                      std::to_string(ReplyReader::kMaxToolCalls) +
                                      " tools at once");
    }
    if (calls.size() <= index) calls.resize(index + 1);
    ToolCall& call = calls[index];
    if (const std::string id = TextAt(piece, "id"); !id.empty()) call.id = id;
    const auto function = piece.find("function");
    if (function == piece.end() || !function->is_object()) continue;
    if (const std::string name = TextAt(*function, "name"); !name.empty()) call.name = name;
    call.arguments += TextAt(*function, "arguments");
    if (call.arguments.size() + call.id.size() + call.name.size() >
        ReplyReader::kMaxArgumentBytes) {
      return Fail(Errc::kTooLong, "the arguments of a tool have more than " +
                                      std::to_string(ReplyReader::kMaxArgumentBytes) + " bytes");
    }
  }
  return {};
}

}  // namespace

vm::Result<std::string> ReplyReader::ReadEvent(const std::string& event) {
  if (event == "[DONE]") {
    complete_ = true;
    return "";
  }
  const auto chunk = vm::ParseAnswer(event);
  if (!chunk || !chunk->is_object()) {
    return Fail(Errc::kSyntax,
                "found '" + vm::ShownAnswer(event) + "' in the answer, expected JSON");
  }
  if (const auto error = ErrorIn(*chunk)) {
    return Fail(Errc::kUnavailable, "the endpoint reports: " + vm::ShownAnswer(*error));
  }
  const auto choices = chunk->find("choices");
  if (choices == chunk->end() || !choices->is_array()) {
    return Fail(Errc::kSyntax,
                "found '" + vm::ShownAnswer(event) + "' in the answer, expected 'choices'");
  }
  if (choices->empty() || !(*choices)[0].is_object()) return "";  // of usage alone
  const json& choice = (*choices)[0];
  if (!TextAt(choice, "finish_reason").empty()) finished_ = true;
  const auto message = choice.find(streams_ ? "delta" : "message");
  if (message == choice.end() || !message->is_object()) return "";
  if (const auto added = AddToolCalls(*message, tool_calls_); !added) {
    return std::unexpected(added.error());
  }
  return ContentOf(*message);
}

vm::Result<void> ReplyReader::Feed(std::string_view bytes, std::string& words) {
  if (complete_) return {};
  if (!streams_) {
    body_ += bytes;
    return {};
  }
  auto events = events_.Feed(bytes);
  if (!events) return std::unexpected(events.error());
  for (const std::string& event : *events) {
    const auto read = ReadEvent(event);
    if (!read) return std::unexpected(read.error());
    words += *read;
    if (complete_) break;
  }
  return {};
}

vm::Result<void> ReplyReader::End(std::string& words) {
  if (complete_) return {};
  if (streams_) {
    complete_ = finished_;
    if (finished_) return {};
    return Fail(Errc::kUnavailable, "the answer broke off before its end");
  }
  const auto read = ReadEvent(body_);
  if (!read) return std::unexpected(read.error());
  words += *read;
  complete_ = true;
  return {};
}

}  // namespace chat
