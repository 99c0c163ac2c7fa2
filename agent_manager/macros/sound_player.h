#pragma once

#include <deque>
#include <string>

#include "agent_manager/macros/built_in_machine.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// The original's @SND: `set Play = FILE` plays a sound file and tells `start FILE` and `end FILE`.
/// The voice plays it (<audio> in SSML) after its current utterance, so that the sound comes out of
/// the same loudspeaker and is in the same recording. Files are played one after the other, on
/// behalf of the peer that set Play.
/// Lifetime: the hub outlives it. Thread: the scheduler's. Limits: kMaxFiles.
/// Errors, answered to that peer: kUnavailable (no voice, no such file), kLimit, the voice's own.
class SoundPlayer final : public BuiltInMachine {
 public:
  static constexpr std::size_t kMaxFiles = 64;
  explicit SoundPlayer(Hub& hub);

  vm::SlotMachine& slots() override { return slots_; }
  void Handle(const Envelope& envelope) override;
  void OnReport(const std::string& from, const vm::Message& message) override;
  void OnPresence(const std::string& name, bool present, const std::string& reason) override;
  void Abandon(const vm::Error& error) override { Drop(error); }
  bool IsAwaitedBy(PeerKey peer) const override;
  bool Busy() const override { return !files_.empty(); }

 private:
  struct File {
    std::string name, path;
    vm::Reply reply;
    Origin origin;
    /// The voice's messages can come together, the end of the sound with the answer to our request.
    enum class State { kWaits, kAsked, kHeard, kOver, kPlaying } state = State::kWaits;
  };
  void Add(const std::string& name, const vm::Reply& reply);
  void Prepare();
  void Speak();
  void Begun();
  void End();
  void Drop(const vm::Error& error);

  Hub& hub_;
  vm::SlotMachine slots_;
  std::deque<File> files_;  // the first was given to the voice
  Origin origin_;           // of the message being handled
};

}  // namespace am
