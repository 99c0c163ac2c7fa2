#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "agent_manager/routing/hub.h"
#include "agent_manager/web/live_piece.h"
#include "vm_protocol/runtime/private_folder.h"

namespace am {

/// What a module shows or says, as pieces with the session's time, while somebody follows: the
/// module is asked to send to a socket of ours (`set SLOT = unix:PATH`; docs/face.md, Pictures for
/// other programs; docs/speech.md, Sound for other programs), and no more once the last has left.
/// Lifetime: `io` and `hub` outlive it. Thread: the context's.
/// Limits: those of vm::LiveRecords, with Origin::max_bytes.
/// Errors end it with a code and a sentence (vm::FormatError): no module, one without the slot or
/// that sends elsewhere already, a record that is none.
class LiveSource {
 public:
  struct Origin {
    const char* module;
    const char* slot;
    const char* who;      ///< in sentences
    const char* records;  ///< the heads it may say, in sentences
    std::size_t max_bytes;
  };
  static const Origin kFace, kVoice;

  LiveSource(boost::asio::io_context& io, Hub& hub, const Origin& origin);
  ~LiveSource();
  LiveSource(const LiveSource&) = delete;

  unsigned Join(Audience::Member member);
  void Leave(unsigned member);

 private:
  /// One connection of the module, from being asked for to its end.
  struct Connection;
  void Begin();
  void Ask(const vm::Message& message, std::function<void(const std::string& value)> next);
  void Read();
  /// Takes whole records out of what has come. An error is a sentence.
  vm::Result<void> TakeRecords();
  /// Nothing: it was asked to.
  void End(const std::optional<vm::Error>& why);

  boost::asio::io_context& io_;
  Hub& hub_;
  const Origin& origin_;
  Audience members_;
  std::shared_ptr<Connection> connection_;  // null while nobody follows
};

}  // namespace am
