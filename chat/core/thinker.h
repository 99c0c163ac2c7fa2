#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "chat/core/history.h"
#include "chat/core/hub_line.h"
#include "chat/model/endpoint.h"
#include "chat/model/model_request.h"

namespace chat {

/// Has a model answer: asks, does what it wants done (tools), asks again with what came of it.
/// Tools are the slots the configuration allows, nothing else. After a refusal for too many
/// requests nothing is sent before the endpoint wants it.
/// Lifetime: clock, transport, hub and endpoint outlive it. Thread: the scheduler's.
class Thinker {
 public:
  struct Settings {
    std::string model;
    std::string system;
    ModelLimits limits;
    int tokens = 400;
    int rounds = 4;  ///< with tools; then it has to answer
  };
  struct Events {
    std::function<void()> began;
    std::function<void(const std::string& words)> words;
    /// The last. Nothing: the answer is complete.
    std::function<void(const std::optional<ModelFailure>& failure)> end;
  };
  Thinker(vm::Scheduler& clock, vm::HttpTransport& transport, HubLine& hub,
          const Endpoint& endpoint);
  ~Thinker();
  Thinker(const Thinker&) = delete;

  /// Asks what the slots that may be set are for, so that the model knows. At most once.
  void LearnSlots();
  /// REQUIRES: nothing is under way.
  void Start(const History& history, Settings settings, Events events);
  /// Ends the connection; no event comes any more.
  void Cancel();

 private:
  struct Round;
  void Ask();
  nlohmann::json ToolDescription() const;
  void OnEnd(std::expected<std::vector<ToolCall>, ModelFailure> end);
  void Perform(std::vector<ToolCall> calls);
  void SetSlot(const ToolCall& call, std::function<void(std::string)> done);
  void Answered(unsigned run, std::size_t index, std::string text);
  void Finish(const std::optional<ModelFailure>& failure);
  /// Ends the request from outside of its events.
  void LetGo();

  vm::Scheduler& clock_;
  vm::HttpTransport& transport_;
  HubLine& hub_;
  const Endpoint& endpoint_;
  std::map<std::string, std::string> help_;  // of slots, by "@MODULE SLOT"
  bool learning_ = false;
  vm::Time not_before_{0};

  Settings settings_;
  Events events_;
  std::unique_ptr<Round> round_;
  unsigned run_ = 0;  // what belongs to earlier ones does not count
};

/// The body of a request. `messages` and `tools` as the endpoint wants them; no tools: null.
std::string RequestBody(const std::string& more, const std::string& model, int tokens,
                        const nlohmann::json& messages, const nlohmann::json& tools);

}  // namespace chat
