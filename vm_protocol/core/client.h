#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/message.h"
#include "vm_protocol/core/result.h"

namespace vm {

/// The other end of the protocol: asks, and pairs the answers with the questions. Pure: whoever
/// owns it carries the lines. Thread: none of its own; one instance, one thread. There is no time
/// limit inside: Abandon() ends requests nobody will answer any more.
class Client {
 public:
  using SendLine = std::function<void(std::string_view line)>;
  using OnAnswer = std::function<void(Result<std::string> value)>;
  using OnMessage = std::function<void(const Message& message)>;

  explicit Client(SendLine send);

  /// Sends `message` with a fresh tag; `on_answer` is called once, with the value or the refusal.
  /// Returns the tag. REQUIRES: IsValid(message).
  std::string Request(Message message, OnAnswer on_answer);
  /// Sends without asking for an answer.
  void Send(const Message& message);
  /// Calls `on_message` for every `rep SLOT` without a tag of ours, from any module; "" =
  /// everything else that comes in (`tell`, and reps nobody listens to).
  void On(std::string slot, OnMessage on_message);

  /// Feed every line that arrives. Lines that are no messages are ignored.
  void HandleLine(std::string_view line);
  /// Ends one request, or with an empty tag all of them, with `error`.
  void Abandon(const std::string& tag, const Error& error);
  std::size_t pending() const { return pending_.size(); }

 private:
  SendLine send_;
  std::map<std::string, std::pair<std::string, OnAnswer>> pending_;  // tag -> slot asked, callback
  std::map<std::string, std::vector<OnMessage>, std::less<>> listeners_;
  unsigned last_tag_ = 0;
};

/// "CODE column N: text" back into an Error (the column stays in the text).
Error ParseError(std::string_view text);

}  // namespace vm
