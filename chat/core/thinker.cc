#include "chat/core/thinker.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "vm_protocol/core/utf8.h"

namespace chat {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using vm::Errc;

constexpr vm::Time kSlotLimit = milliseconds(5000);
constexpr vm::Time kHelpLimit = milliseconds(10'000);
constexpr std::size_t kMaxHelp = 400;
constexpr std::size_t kMaxValue = 2000;
constexpr std::size_t kBytesPerByte = 256;  // of a stream, for a byte of words
constexpr const char* kTool = "set_slot";

std::string Dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

/// What the model has been told and has done in this answer.
struct Thinker::Round {
  json messages = json::array();
  std::string words;  // of this request
  std::vector<ToolCall> calls;
  std::vector<std::optional<std::string>> results;
  int number = 0;
  std::unique_ptr<ModelRequest> request;
};

std::string RequestBody(const std::string& more, const std::string& model, int tokens,
                        const json& messages, const json& tools) {
  json body = json::parse(more, nullptr, false);
  if (!body.is_object()) body = json::object();
  body["model"] = model;
  body["messages"] = messages;
  body["stream"] = true;
  if (!body.contains("max_tokens") && !body.contains("max_completion_tokens"))
    body["max_tokens"] = tokens;
  if (!tools.is_null()) body["tools"] = tools;
  return Dumped(body);
}

Thinker::Thinker(vm::Scheduler& clock, vm::HttpTransport& transport, HubLine& hub,
                 const Endpoint& endpoint)
    : clock_(clock), transport_(transport), hub_(hub), endpoint_(endpoint) {}

Thinker::~Thinker() = default;

void Thinker::LearnSlots() {
  if (std::exchange(learning_, true)) return;
  for (const std::string& place : endpoint_.allow_set) {
    const auto allowed = ParseAllowed(place);
    if (!allowed) continue;
    hub_.Ask(vm::To(allowed->module, vm::Inq(allowed->slot + ".help")), kHelpLimit,
             [this, place](const vm::Result<std::string>& help) {
               if (help) help_[place] = vm::CutUtf8(*help, kMaxHelp);
             });
  }
}

json Thinker::ToolDescription() const {
  std::string what = "Sets a slot of the agent, which changes how it looks or what it does.";
  for (const std::string& place : endpoint_.allow_set) {
    const auto help = help_.find(place);
    what += "\n" + place + (help == help_.end() ? "" : ": " + help->second);
  }
  return json::array({{{"type", "function"},
                       {"function",
                        {{"name", kTool},
                         {"description", what},
                         {"parameters",
                          {{"type", "object"},
                           {"properties",
                            {{"slot", {{"type", "string"}, {"enum", endpoint_.allow_set}}},
                             {"value", {{"type", "string"}}}}},
                           {"required", {"slot", "value"}}}}}}}});
}

void Thinker::Start(const History& history, Settings settings, Events events) {
  settings_ = std::move(settings);
  events_ = std::move(events);
  ++run_;
  if (clock_.Now() < not_before_) {
    const auto left = std::chrono::ceil<std::chrono::seconds>(not_before_ - clock_.Now());
    clock_.Post([this, run = run_, left] {
      if (run != run_) return;
      Finish(ModelFailure{.trouble = Trouble::kBusy,
                          .error = {Errc::kBusy,
                                    "the endpoint wants no further request for " +
                                        std::to_string(left.count()) + " s, nothing was sent",
                                    0}});
    });
    return;
  }
  round_ = std::make_unique<Round>();
  round_->messages.push_back({{"role", "system"}, {"content", settings_.system}});
  for (const History::Entry& entry : history.entries()) {
    round_->messages.push_back(
        {{"role", entry.user ? "user" : "assistant"}, {"content", entry.text}});
  }
  Ask();
}

void Thinker::Ask() {
  Round& round = *round_;
  round.words.clear();
  const bool tools = !endpoint_.allow_set.empty() && round.number < settings_.rounds;
  vm::HttpRequest request{
      .url = endpoint_.url,
      .headers = {"Content-Type: application/json", "Accept: text/event-stream, application/json"},
      .body = RequestBody(endpoint_.more, settings_.model, settings_.tokens, round.messages,
                          tools ? ToolDescription() : json()),
      .limit = settings_.limits.whole,
      .max_bytes = settings_.limits.reply_bytes * kBytesPerByte};
  if (!endpoint_.key.empty()) request.headers.push_back("Authorization: Bearer " + endpoint_.key);
  round.request = std::make_unique<ModelRequest>(
      clock_, transport_, std::move(request), endpoint_.key, settings_.limits,
      ModelRequest::Events{.began = [this] { events_.began(); },
                           .words =
                               [this](const std::string& words) {
                                 round_->words += words;
                                 events_.words(words);
                               },
                           .end = [this](auto end) { OnEnd(std::move(end)); }});
}

void Thinker::LetGo() {
  if (!round_ || !round_->request) return;
  // It is within one of its events.
  clock_.Post([gone = std::shared_ptr<ModelRequest>(std::move(round_->request))] {});
}

void Thinker::Cancel() {
  ++run_;
  round_.reset();
}

void Thinker::Finish(const std::optional<ModelFailure>& failure) {
  LetGo();
  round_.reset();
  ++run_;
  const auto end = events_.end;  // may start anew
  end(failure);
}

void Thinker::OnEnd(std::expected<std::vector<ToolCall>, ModelFailure> end) {
  if (!end) {
    if (end.error().wait.count() > 0) not_before_ = clock_.Now() + end.error().wait;
    return Finish(end.error());
  }
  if (end->empty()) return Finish({});
  if (endpoint_.allow_set.empty() || round_->number >= settings_.rounds) {
    return Finish(
        ModelFailure{.trouble = Trouble::kLong,
                     .error = {Errc::kLimit,
                               "the model calls tools in more than " +
                                   std::to_string(settings_.rounds) + " rounds (Tools.rounds)",
                               0}});
  }
  LetGo();
  Perform(std::move(*end));
}

void Thinker::Perform(std::vector<ToolCall> calls) {
  Round& round = *round_;
  ++round.number;
  json asked = json::array();
  for (std::size_t i = 0; i < calls.size(); ++i) {
    if (calls[i].id.empty()) calls[i].id = "call_" + std::to_string(i);
    asked.push_back({{"id", calls[i].id},
                     {"type", "function"},
                     {"function", {{"name", calls[i].name}, {"arguments", calls[i].arguments}}}});
  }
  round.messages.push_back(
      {{"role", "assistant"}, {"content", round.words}, {"tool_calls", std::move(asked)}});
  round.calls = std::move(calls);
  round.results.assign(round.calls.size(), std::nullopt);
  for (std::size_t i = 0; i < round.calls.size(); ++i) {
    SetSlot(round.calls[i], [this, run = run_, i](std::string text) {
      // Later, so that all of them are under way before the first is answered.
      clock_.Post([this, run, i, text = std::move(text)] { Answered(run, i, text); });
    });
  }
}

/// `done` gets what the model is told of it.
void Thinker::SetSlot(const ToolCall& call, std::function<void(std::string)> done) {
  const json arguments = json::parse(call.arguments, nullptr, false);
  const auto text = [&arguments](const char* key) -> std::optional<std::string> {
    if (!arguments.is_object() || !arguments.contains(key)) return {};
    const json& value = arguments[key];
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number() || value.is_boolean()) return value.dump();
    return {};
  };
  const auto place = text("slot");
  const auto value = text("value");
  if (call.name != kTool) return done("error: there is only the tool set_slot");
  if (!place || !value)
    return done("error: expected {\"slot\": \"@MODULE SLOT\", \"value\": \"...\"}");
  const auto& allowed = endpoint_.allow_set;
  if (std::ranges::find(allowed, *place) == allowed.end())
    return done("error: this slot may not be set");
  const auto parsed = ParseAllowed(*place);
  const bool one_line = std::ranges::none_of(
      *value, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  vm::Message message;
  if (parsed) message = vm::To(parsed->module, vm::Set(parsed->slot, *value));
  if (!parsed || !one_line || value->size() > kMaxValue || !vm::IsValid(message))
    return done("error: the value is too long, or more than one line of text");
  hub_.Ask(std::move(message), kSlotLimit, [done](const vm::Result<std::string>& answer) {
    done(answer ? "ok: " + *answer : "error: " + vm::FormatError(answer.error()));
  });
}

void Thinker::Answered(unsigned run, std::size_t index, std::string text) {
  if (run != run_ || !round_ || index >= round_->results.size()) return;
  Round& round = *round_;
  round.results[index] = std::move(text);
  if (!std::ranges::all_of(round.results, [](const auto& one) { return one.has_value(); })) return;
  for (std::size_t i = 0; i < round.calls.size(); ++i) {
    round.messages.push_back(
        {{"role", "tool"}, {"tool_call_id", round.calls[i].id}, {"content", *round.results[i]}});
  }
  round.calls.clear();
  round.results.clear();
  Ask();
}

}  // namespace chat
