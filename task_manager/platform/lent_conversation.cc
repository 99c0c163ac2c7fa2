#include "task_manager/platform/lent_conversation.h"

#include <charconv>
#include <utility>

#include "vm_protocol/core/lower_case.h"

namespace vxml {
namespace {

constexpr Millis kPatience{10'000};  // the voice is stopped, and says what was heard

std::string OneLine(std::string text) {
  for (char& c : text) c = c == '\n' || c == '\r' ? ' ' : c;
  return text;
}

TalkResult::Kind KindOf(vm::Errc code) {
  switch (code) {
    case vm::Errc::kUnknownModule:
    case vm::Errc::kUnknownSlot:
      return TalkResult::Kind::kUnsupported;
    case vm::Errc::kBusy:
      return TalkResult::Kind::kBusy;
    default:
      return TalkResult::Kind::kFailed;
  }
}

/// "SILENCE 3 see you" of slot Talk.over.
void ReadEnd(const std::string& value, TalkResult& result) {
  const std::size_t blank = value.find(' ');
  result.reason = vm::LowerCase(value.substr(0, blank));
  if (blank == std::string::npos) return;
  const char* const end = value.data() + value.size();
  const auto turns = std::from_chars(value.data() + blank + 1, end, result.turns);
  if (turns.ptr != end) result.last.assign(turns.ptr + 1, end);
}

}  // namespace

LentConversation::LentConversation(HubLink& hub, std::string chat, OnWords on_words)
    : hub_(hub), chat_(std::move(chat)), on_words_(std::move(on_words)) {}

LentConversation::~LentConversation() {
  *alive_ = false;
  if (begun_ && !over_ && !hub_.gone()) hub_.Send("to @" + chat_ + " set Talk = STOP");
}

void LentConversation::Begin(const TalkRequest& request, Millis silence) {
  const std::string to_chat = "to @" + chat_ + " set ";
  for (const auto& [slot, text] :
       {std::pair("Talk.goal", request.goal), std::pair("Talk.end", request.end_phrases)}) {
    if (text.empty()) continue;
    const auto set = hub_.Ask(to_chat + slot + " = " + OneLine(text), kAnswer);
    if (!set) return Fail(set.error());
  }
  auto message = vm::ParseMessage(to_chat + "Talk = " + std::to_string(request.turns) + " " +
                                  std::to_string(silence.count()) + " " + hub_.name());
  if (!message) return Fail(message.error());
  begun_ = true;
  hub_.client().Request(*message, [this, alive = alive_](const vm::Result<std::string>& answer) {
    if (*alive) OnAnswer(answer);
  });
}

void LentConversation::OnAnswer(const vm::Result<std::string>& answer) {
  if (!answer) return Fail(answer.error());
  lent_ = true;  // what Talk.over tells before this is the end of another
}

void LentConversation::OnOver(const std::string& end) {
  constexpr std::string_view kFailed = "FAILED ";
  if (!lent_ || over_) return;
  if (end.starts_with(kFailed)) return Fail(vm::ParseError(end.substr(kFailed.size())));
  over_ = true;
  ReadEnd(end, result_);
}

void LentConversation::Fail(const vm::Error& error) {
  over_ = true;
  result_.kind = KindOf(error.code);
  result_.reason = error.text;
}

void LentConversation::OnReport(const vm::Message& message) {
  if (message.slot == "Talk.over") return OnOver(message.value);
  const bool user = message.slot == "Heard";
  if (message.slot == "Busy") idle_ = message.value == "IDLE";
  if (user) ++heard_;
  if (user) idle_ = false;  // until it says so again
  if (user || message.slot == "Reply.sentence") on_words_(user, message.value);
  // A reply counts as far as it was heard, which is known at its end.
  if ((user || message.slot == "Reply") && !message.value.empty() &&
      result_.words.size() < kMaxWords) {
    result_.words.push_back({user, message.value});
  }
}

void LentConversation::Stop(const std::string& reason) {
  if (over_ || !begun_) return;
  reason_ = reason;
  hub_.Send("to @" + chat_ + " set Say = STOP");
  hub_.Send("to @" + chat_ + " set Talk = STOP");
  hub_.WaitFor([this] { return over_; }, kPatience);
  if (!over_) Fail({vm::Errc::kTimeout, "@" + chat_ + " does not give the conversation back", 0});
}

TalkResult LentConversation::Take() {
  if (result_.kind == TalkResult::Kind::kOver) {
    if (!reason_.empty()) result_.reason = reason_;
    result_.result = hub_.Ask("to @" + chat_ + " inq Talk.result", kAnswer).value_or("");
  }
  return std::move(result_);
}

}  // namespace vxml
