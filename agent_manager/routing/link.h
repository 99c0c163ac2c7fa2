#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "vm_protocol/core/message.h"

namespace am {

/// A message on its way out, to one peer or to many: whoever needs its line has it written once.
/// Lifetime: of the call it is given to; the message outlives it.
class Outgoing {
 public:
  explicit Outgoing(const vm::Message& message) : message_(message) {}
  Outgoing(const Outgoing&) = delete;
  const vm::Message& message() const { return message_; }
  /// The message as a line, without its newline.
  const std::string& line() const {
    if (!line_) line_ = vm::FormatMessage(message_);
    return *line_;
  }

 private:
  const vm::Message& message_;
  mutable std::optional<std::string> line_;
};

/// What carries messages to one peer. The hub owns it while the peer is attached. No call leads
/// back into the hub before it returns.
class Link {
 public:
  virtual ~Link() = default;
  virtual void Send(const Outgoing& outgoing) = 0;
  /// A line that is no message (`# ...`), for peers that read lines.
  virtual void SendComment(std::string_view) {}
  virtual void Close() = 0;
  /// Calls `done`, later or at once, when what was sent has been taken by the system.
  virtual void WhenSent(std::function<void()> done) { done(); }
  /// Stops and resumes the lines that come from it.
  virtual void PauseReading() {}
  virtual void ResumeReading() {}
  /// What was sent and has not been taken yet.
  virtual std::size_t backlog_bytes() const { return 0; }
};

}  // namespace am
