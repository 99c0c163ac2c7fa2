#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "task_manager/platform/hub_link.h"
#include "task_manager/platform/platform.h"

namespace vxml {

/// The user lent to the module that converses (slot Talk of @CHAT), and what it tells meanwhile.
/// Ownership: whoever lends; `hub` outlives it. An end before the conversation's own stops that.
/// Thread: the session's; what comes is handled in the hub's waits.
class LentConversation {
 public:
  static constexpr std::size_t kMaxWords = 400;  ///< pieces of what both said; later ones are lost
  using OnWords = std::function<void(bool user, const std::string& text)>;

  /// `chat` is the module's name at the hub. `on_words`: the user was heard, a sentence begins.
  LentConversation(HubLink& hub, std::string chat, OnWords on_words);
  ~LentConversation();
  LentConversation(const LentConversation&) = delete;

  /// Begins; `silence` 0: it does not end by silence. A refusal ends it.
  void Begin(const TalkRequest& request, Millis silence);
  void OnReport(const vm::Message& message);
  /// Words are on their way to it by way of the ear, or were not taken there.
  void Said() { ++said_; }
  void NotTaken() { --said_; }
  /// Nobody speaks, and nothing said is on its way.
  bool WaitsForUser() const { return !over_ && idle_ && heard_ >= said_; }
  bool over() const { return over_; }
  /// Takes the user back and waits for that; `reason` is the result's.
  void Stop(const std::string& reason);
  /// REQUIRES: over().
  TalkResult Take();

 private:
  void OnAnswer(const vm::Result<std::string>& answer);
  void OnOver(const std::string& end);
  void Fail(const vm::Error& error);

  HubLink& hub_;
  const std::string chat_;
  const OnWords on_words_;
  TalkResult result_;
  std::string reason_;  ///< why it was stopped by us
  int said_ = 0, heard_ = 0;
  bool idle_ = true;
  bool begun_ = false;
  bool over_ = false;
  bool lent_ = false;
  /// Answers that come after the end of this object are nobody's.
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace vxml
