#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "agent_manager/routing/hub.h"
#include "agent_manager/web/live_piece.h"
#include "agent_manager/web/private_folder.h"

namespace am {

/// What the voice says, as sound with the session's time, while somebody listens: the voice is
/// asked to send a copy to a socket of ours (`set Sound.to = unix:PATH`, docs/speech.md), and no
/// more once the last has left. Lifetime: `io` and `hub` outlive it. Thread: the context's. Limits:
/// kMaxHeadBytes and kMaxSoundBytes of a record. Errors end the sound with a sentence: no voice,
/// one without sound or whose sound goes elsewhere, a record that is none.
class VoiceSound {
 public:
  static constexpr std::size_t kMaxHeadBytes = 128;
  static constexpr std::size_t kMaxSoundBytes = 64u * 1024;
  VoiceSound(boost::asio::io_context& io, Hub& hub);
  ~VoiceSound();
  VoiceSound(const VoiceSound&) = delete;

  unsigned Listen(Audience::Member member);
  void Leave(unsigned member);

 private:
  /// One connection of the voice, from being asked for to its end.
  struct Connection;
  void Begin();
  void Ask(const vm::Message& message, std::function<void(const std::string& value)> next);
  void Read();
  /// Takes whole records out of what has come. An error is a sentence.
  vm::Result<void> TakeRecords();
  void End(const std::string& why);

  boost::asio::io_context& io_;
  Hub& hub_;
  Audience listeners_;
  std::shared_ptr<Connection> connection_;  // null while nobody listens
};

}  // namespace am
