#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "chat/model/reply_reader.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/http/http.h"

namespace chat {

/// What went wrong, for what is said to the user (tables/apologies.txt).
enum class Trouble { kAway, kRefused, kBusy, kLate, kBroken, kLong };

struct ModelFailure {
  Trouble trouble = Trouble::kAway;
  vm::Error error;
  /// The endpoint wants no further request for so long.
  std::chrono::milliseconds wait{0};
};

struct ModelLimits {
  std::chrono::milliseconds whole{60'000};  ///< from the request to the end of the answer
  std::chrono::milliseconds stall{15'000};  ///< without anything new
  std::size_t reply_bytes = 16 << 10;       ///< of words
};

/// One question to the model and its answer. Destroying it ends the connection; that must not be
/// done from within an event.
/// Lifetime: clock and transport outlive it. Thread: the scheduler's.
class ModelRequest {
 public:
  struct Events {
    std::function<void()> began;  ///< the first words, or the first tool
    std::function<void(const std::string& words)> words;
    /// Once, the last: what the model asks to have done (often nothing), or what went wrong.
    std::function<void(std::expected<std::vector<ToolCall>, ModelFailure> end)> end;
  };
  ModelRequest(vm::Scheduler& clock, vm::HttpTransport& transport, vm::HttpRequest request,
               const std::string& key, ModelLimits limits, Events events);
  ~ModelRequest();
  ModelRequest(const ModelRequest&) = delete;

 private:
  void OnHead(const vm::HttpHead& head);
  void OnData(std::string_view bytes);
  void OnEnd(const vm::Result<void>& end);
  void Give(const std::string& words);
  void WaitForMore();
  void Fail(Trouble trouble, vm::Errc code, std::string text, std::chrono::milliseconds wait = {});
  void Finish(std::expected<std::vector<ToolCall>, ModelFailure> end);
  void FailByStatus();

  vm::Scheduler& clock_;
  const std::string url_;
  const std::string key_;
  const ModelLimits limits_;
  const Events events_;
  std::optional<vm::HttpHead> head_;
  std::optional<ReplyReader> reader_;  // of an answer that is none of an error
  std::string error_body_;
  std::size_t given_ = 0;
  bool began_ = false;
  bool ended_ = false;
  vm::TimerId stall_timer_ = 0, whole_timer_ = 0;
  std::unique_ptr<vm::HttpExchange> exchange_;
};

}  // namespace chat
