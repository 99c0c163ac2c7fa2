#pragma once

#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/mcp/slot_tool.h"
#include "vm_protocol/core/message.h"

namespace gateway {

/// Slots as tools for language models: the Model Context Protocol, revisions 2025-11-25 and
/// 2025-06-18, as messages of JSON-RPC 2.0. What carries them, and what reaches the modules, is
/// the caller's.
/// Only slots that `allowed` names are tools: "@MODULE SLOT", in which * stands for any letters.
/// The modules are asked what these are when tools are first wanted, and again where one did not
/// answer. Lifetime: hooks outlive it; answers that come later are passed over. Thread: none of its
/// own. Limits: kMaxTools; kMaxRunning calls and listings at a time, beyond which they are refused.
class McpServer {
 public:
  static constexpr std::size_t kMaxTools = 256;
  static constexpr std::size_t kMaxRunning = 32;
  using OnAnswer = std::function<void(vm::Result<std::string> value)>;
  /// Takes one message for the client.
  using Say = std::function<void(const std::string& message)>;
  using GiveUp = std::function<void()>;
  struct Hooks {
    /// Asks a module; answered once, within a time limit of the caller's. Returns what gives the
    /// question up: it is then answered at once, or not at all.
    std::function<GiveUp(vm::Message message, OnAnswer on_answer)> ask;
  };
  /// A message that asks: its id, and where its answer goes.
  struct Question;
  using QuestionPtr = std::shared_ptr<Question>;
  struct Allowed {
    std::string module, slot;  ///< the module's name is no pattern
  };
  McpServer(std::vector<Allowed> allowed, Hooks hooks);
  ~McpServer() { *alive_ = false; }
  McpServer(const McpServer&) = delete;

  /// Whether that revision of the protocol is spoken.
  static bool Speaks(std::string_view revision);
  /// One message of a client's. Not null: it asks for an answer, which `say` gets once, now or
  /// later.
  QuestionPtr Handle(std::string_view message, Say say);
  /// The client has gone: its question is given up, and leaves its place to others. What a module
  /// has been told stays told.
  void Forget(const QuestionPtr& question);
  /// Calls and listings that are not answered yet.
  std::size_t running() const { return running_; }

 private:
  struct Discovery;
  void Request(const QuestionPtr& question, const std::string& method,
               const nlohmann::json& params);
  void Initialize(const QuestionPtr& question, const nlohmann::json& params);
  void List(const QuestionPtr& question);
  void Call(const QuestionPtr& question, const nlohmann::json& params);
  void CallTool(const QuestionPtr& question, const SlotTool& tool, const nlohmann::json& params);
  void Result(const QuestionPtr& question, nlohmann::json result);
  void Error(const QuestionPtr& question, int code, const std::string& text);
  void Answer(const QuestionPtr& question, nlohmann::json answer);
  /// Takes the question's place from it, if it has one.
  void Leave(Question& question);
  /// Calls `next` once all modules have told of their slots, or have not; not if the question was
  /// forgotten before.
  void Discover(const QuestionPtr& question, std::function<void()> next);
  void AskModule(const std::shared_ptr<Discovery>& discovery, const std::string& module);
  void AskSlot(const std::shared_ptr<Discovery>& discovery, const std::string& module,
               const std::string& slot);
  void Answered(const std::shared_ptr<Discovery>& discovery);
  GiveUp Ask(vm::Message message, OnAnswer on_answer);

  const std::vector<Allowed> allowed_;
  const Hooks hooks_;
  std::map<std::string, SlotTool> tools_;  // by name
  bool complete_ = false;                  // every module has answered
  std::shared_ptr<Discovery> discovery_;   // while it goes on
  std::size_t running_ = 0;
  const std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

/// "@FSM FaceExp" taken apart. kBadValue for anything else.
vm::Result<McpServer::Allowed> ParseAllowed(std::string_view text);

}  // namespace gateway
