#include "gateway/mcp/mcp_server.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "vm_protocol/core/utf8.h"
#include "vm_protocol/http/answer.h"

namespace gateway {
namespace {

using nlohmann::json;

constexpr const char* kRevisions[] = {"2025-11-25", "2025-06-18"};  // the newest first
// JSON-RPC 2.0, section 5.1.
constexpr int kParseError = -32700, kInvalidRequest = -32600, kNoMethod = -32601,
              kInvalidParams = -32602, kBusy = -32000;

json ToolText(const std::string& text, bool error) {
  return {{"content", json::array({{{"type", "text"}, {"text", text}}})}, {"isError", error}};
}

std::vector<std::string> Words(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    if (end > at) words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

/// A value of a call's as the slot takes it; nothing for what is no text, number or truth.
std::optional<std::string> ValueText(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "ON" : "OFF";
  if (value.is_number()) return value.dump();
  return {};
}

}  // namespace

struct McpServer::Question {
  json id;
  Say say;  // empty once it is answered or forgotten
  bool counted = false;
  GiveUp give_up{};  // while a module is asked for it
};

struct McpServer::Discovery {
  std::size_t open = 0;   // questions
  std::size_t slots = 0;  // asked about
  bool failed = false;
  std::map<std::string, SlotTool> tools;
  std::vector<std::pair<QuestionPtr, std::function<void()>>> next;
};

vm::Result<McpServer::Allowed> ParseAllowed(std::string_view text) {
  const std::size_t blank = std::min(text.find(' '), text.size());
  McpServer::Allowed allowed{std::string(text.substr(0, blank)),
                             std::string(text.substr(std::min(blank + 1, text.size())))};
  if (allowed.module.starts_with('@')) allowed.module.erase(0, 1);
  std::string plain = allowed.slot;
  std::ranges::replace(plain, '*', 'x');
  if (!vm::IsModuleName(allowed.module) || !vm::IsSlotName(plain)) {
    return vm::Fail(vm::Errc::kBadValue,
                    "found '" + vm::ShownUtf8(vm::CutUtf8(text, 80)) + "', expected @MODULE SLOT");
  }
  return allowed;
}

McpServer::McpServer(std::vector<Allowed> allowed, Hooks hooks)
    : allowed_(std::move(allowed)), hooks_(std::move(hooks)) {}

bool McpServer::Speaks(std::string_view revision) {
  return std::ranges::find(kRevisions, revision) != std::end(kRevisions);
}

McpServer::QuestionPtr McpServer::Handle(std::string_view text, Say say) {
  const auto question = std::make_shared<Question>(Question{nullptr, std::move(say)});
  const auto refuse = [&](int code, const std::string& why) {
    Error(question, code, why);
    return question;
  };
  const auto message = vm::ParseAnswer(text);
  if (!message) return refuse(kParseError, "no JSON, or nested too deep");
  const auto id = message->is_object() ? message->find("id") : message->end();
  const bool asks = message->is_object() && id != message->end();
  if (!message->is_object() || vm::TextAt(*message, "jsonrpc") != "2.0" ||
      (asks && !id->is_string() && !id->is_number_integer())) {
    return refuse(kInvalidRequest,
                  "expected one object {\"jsonrpc\": \"2.0\", \"id\", \"method\", \"params\"}");
  }
  // An answer, though we ask nothing; or a notification: initialized, cancelled.
  if (!message->contains("method") || !asks) return nullptr;
  question->id = *id;
  const auto params = message->find("params");
  Request(question, vm::TextAt(*message, "method"),
          params != message->end() && params->is_object() ? *params : json::object());
  return question;
}

void McpServer::Forget(const QuestionPtr& question) {
  question->say = nullptr;
  Leave(*question);
  if (discovery_) {
    std::erase_if(discovery_->next, [&](const auto& next) { return next.first == question; });
  }
  if (const GiveUp give_up = std::exchange(question->give_up, nullptr)) give_up();
}

void McpServer::Request(const QuestionPtr& question, const std::string& method,
                        const json& params) {
  if (method == "initialize") return Initialize(question, params);
  if (method == "ping") return Result(question, json::object());
  if (method != "tools/list" && method != "tools/call") {
    return Error(question, kNoMethod, "there is no method '" + vm::ShownAnswer(method) + "'");
  }
  if (running_ >= kMaxRunning) {
    return Error(question, kBusy,
                 std::to_string(kMaxRunning) + " calls and listings are running already");
  }
  question->counted = true;
  ++running_;
  if (method == "tools/call") return Call(question, params);
  Discover(question, [this, question] { List(question); });
}

void McpServer::Initialize(const QuestionPtr& question, const json& params) {
  const std::string wanted = vm::TextAt(params, "protocolVersion");
  const bool known = Speaks(wanted);
  Result(question,
         {{"protocolVersion", known ? wanted : kRevisions[0]},
          {"capabilities", {{"tools", json::object()}}},
          {"serverInfo", {{"name", "galatea"}, {"title", "Galatea"}, {"version", GALATEA_VERSION}}},
          {"instructions",
           "Tools are slots of a talking agent with a face: what each does stands in its "
           "description, in the words of the module that has it."}});
}

void McpServer::List(const QuestionPtr& question) {
  json tools = json::array();
  for (const auto& [name, tool] : tools_) tools.push_back(tool.Description());
  Result(question, {{"tools", std::move(tools)}});
}

void McpServer::Call(const QuestionPtr& question, const json& params) {
  const std::string name = vm::TextAt(params, "name");
  if (const auto found = tools_.find(name); found != tools_.end()) {
    return CallTool(question, found->second, params);
  }
  // A client may call what an earlier run of ours has listed.
  Discover(question, [this, question, name, params] {
    const auto found = tools_.find(name);
    if (found != tools_.end()) return CallTool(question, found->second, params);
    Error(question, kInvalidParams, "there is no tool '" + vm::ShownAnswer(name) + "'");
  });
}

void McpServer::CallTool(const QuestionPtr& question, const SlotTool& tool, const json& params) {
  const auto arguments = params.find("arguments");
  const bool given = arguments != params.end() && arguments->is_object();
  std::optional<std::string> value;
  if (given && arguments->contains("value")) {
    value = ValueText((*arguments)["value"]);
    if (!value) return Error(question, kInvalidParams, "value: expected a text or a number");
  }
  if (!value && !tool.readable)
    return Error(question, kInvalidParams, "value: expected, it is missing");
  if (value && !tool.writable) {
    return Error(question, kInvalidParams, "value: found, but the slot can only be asked");
  }
  vm::Message message = value ? vm::Set(tool.slot, *value) : vm::Inq(tool.slot);
  message.to = {tool.module};
  if (!vm::IsValid(message)) {
    return Error(question, kInvalidParams, "value: expected one line of at most 60 KiB");
  }
  auto give_up = Ask(std::move(message), [this, question](vm::Result<std::string> answer) {
    // What a module refuses is for the model to read and mend, not an error of the protocol.
    Result(question,
           answer ? ToolText(*answer, false) : ToolText(vm::FormatError(answer.error()), true));
  });
  if (question->say) question->give_up = std::move(give_up);  // else it is answered already
}

McpServer::GiveUp McpServer::Ask(vm::Message message, OnAnswer on_answer) {
  return hooks_.ask(std::move(message), [alive = alive_, on_answer = std::move(on_answer)](
                                            vm::Result<std::string> answer) {
    if (*alive) on_answer(std::move(answer));
  });
}

void McpServer::Discover(const QuestionPtr& question, std::function<void()> next) {
  if (complete_) return next();
  if (discovery_) {
    discovery_->next.emplace_back(question, std::move(next));
    return;
  }
  const auto discovery = discovery_ = std::make_shared<Discovery>();
  discovery->next.emplace_back(question, std::move(next));
  std::set<std::string> modules;
  for (const Allowed& allowed : allowed_) modules.insert(allowed.module);
  ++discovery->open;  // until all have been asked
  for (const std::string& module : modules) AskModule(discovery, module);
  Answered(discovery);
}

void McpServer::AskModule(const std::shared_ptr<Discovery>& discovery, const std::string& module) {
  ++discovery->open;
  Ask(vm::To(module, vm::Inq("Slots")), [this, discovery, module](vm::Result<std::string> answer) {
    discovery->failed = discovery->failed || !answer;
    for (const std::string& slot : Words(answer.value_or(""))) {
      const bool wanted = std::ranges::any_of(allowed_, [&](const Allowed& allowed) {
        return allowed.module == module && MatchesPattern(allowed.slot, slot);
      });
      if (wanted && discovery->slots < kMaxTools) AskSlot(discovery, module, slot);
    }
    Answered(discovery);
  });
}

void McpServer::AskSlot(const std::shared_ptr<Discovery>& discovery, const std::string& module,
                        const std::string& slot) {
  ++discovery->open;
  ++discovery->slots;
  Ask(vm::To(module, vm::Inq(slot + ".help")),
      [this, discovery, module, slot](vm::Result<std::string> help) {
        Ask(vm::To(module, vm::Inq(slot + ".prop")),
            [this, discovery, module, slot, help](const vm::Result<std::string>& attributes) {
              if (help && attributes) {
                SlotTool tool = MakeSlotTool(module, slot, *help, *attributes);
                const std::string name = tool.Name();
                discovery->tools.emplace(name, std::move(tool));
              }
              discovery->failed = discovery->failed || !help || !attributes;
              Answered(discovery);
            });
      });
}

void McpServer::Answered(const std::shared_ptr<Discovery>& discovery) {
  if (--discovery->open > 0) return;
  tools_ = std::move(discovery->tools);
  complete_ = !discovery->failed;
  discovery_.reset();
  for (const auto& [question, next] : discovery->next) next();
}

void McpServer::Leave(Question& question) {
  if (std::exchange(question.counted, false)) --running_;
}

void McpServer::Result(const QuestionPtr& question, json result) {
  Answer(question, {{"jsonrpc", "2.0"}, {"id", question->id}, {"result", std::move(result)}});
}

void McpServer::Error(const QuestionPtr& question, int code, const std::string& text) {
  Answer(
      question,
      {{"jsonrpc", "2.0"}, {"id", question->id}, {"error", {{"code", code}, {"message", text}}}});
}

void McpServer::Answer(const QuestionPtr& question, json answer) {
  Leave(*question);
  question->give_up = nullptr;
  if (const Say say = std::exchange(question->say, nullptr)) {
    say(answer.dump(-1, ' ', false, json::error_handler_t::replace));
  }
}

}  // namespace gateway
