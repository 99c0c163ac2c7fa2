#include "vm_protocol/core/client.h"

#include <utility>

namespace vm {

Client::Client(SendLine send) : send_(std::move(send)) {}

std::string Client::Request(Message message, OnAnswer on_answer) {
  message.tag = "c" + std::to_string(++last_tag_);
  pending_[message.tag] = {
      message.slot.empty() ? std::string(CommandName(message.command)) : message.slot,
      std::move(on_answer)};
  send_(FormatMessage(message));
  return message.tag;
}

void Client::Send(const Message& message) { send_(FormatMessage(message)); }

void Client::On(std::string slot, OnMessage on_message) {
  listeners_[std::move(slot)].push_back(std::move(on_message));
}

void Client::HandleLine(std::string_view line) {
  const auto message = ParseMessage(line);
  if (!message) return;
  if (message->command == Command::kRep && !message->tag.empty()) {
    const auto found = pending_.find(message->tag);
    if (found == pending_.end()) return;
    const bool refused =
        message->slot == found->second.first + ".error" || message->slot == "Error";
    // Members of a group come before the answer itself; they are passed on as plain reports.
    if (refused || message->slot == found->second.first) {
      const OnAnswer on_answer = std::move(found->second.second);
      pending_.erase(found);
      if (refused) {
        on_answer(std::unexpected(ParseError(message->value)));
      } else {
        on_answer(message->value);
      }
      return;
    }
  }
  auto listeners = listeners_.find(message->slot);
  if (listeners == listeners_.end() || message->command != Command::kRep)
    listeners = listeners_.find("");
  if (listeners == listeners_.end()) return;
  const auto callbacks = listeners->second;  // a copy: a callback may add listeners
  for (const OnMessage& on_message : callbacks) on_message(*message);
}

void Client::Abandon(const std::string& tag, const Error& error) {
  auto ending = std::exchange(pending_, {});
  for (auto& [pending_tag, entry] : ending) {
    if (tag.empty() || tag == pending_tag) {
      entry.second(std::unexpected(error));
    } else {
      pending_.emplace(pending_tag, std::move(entry));
    }
  }
}

Error ParseError(std::string_view text) {
  const std::size_t blank = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, blank);
  Error error{Errc::kInternal, std::string(blank < text.size() ? text.substr(blank + 1) : text), 0};
  for (int code = 0; code <= static_cast<int>(Errc::kInternal); ++code) {
    if (ErrcName(static_cast<Errc>(code)) == word) error.code = static_cast<Errc>(code);
  }
  return error;
}

}  // namespace vm
