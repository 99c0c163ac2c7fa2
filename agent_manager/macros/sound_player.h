#pragma once

#include <deque>
#include <string>

#include "agent_manager/macros/built_in_module.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// The original's @SND: `set Play = FILE` plays a sound file and tells `start FILE` and `end FILE`.
/// The voice plays it, as <audio> of SSML, after what it is speaking, so that it comes from where
/// the voice comes from and is on the same recording. One file after the other. It is asked for as
/// whoever set Play. Thread: the scheduler's. The hub outlives it. Limits: kMaxFiles.
/// Errors, to whoever set Play: kUnavailable (no voice, no such file), kLimit, and the voice's own.
class SoundPlayer final : public BuiltInModule {
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
    bool playing = false;
  };
  void Add(const std::string& name, const vm::Reply& reply);
  void Prepare();
  void Speak();
  void End();
  void Drop(const vm::Error& error);

  Hub& hub_;
  vm::SlotMachine slots_;
  std::deque<File> files_;  // the first is with the voice
  Origin origin_;           // of the message being handled
};

}  // namespace am
