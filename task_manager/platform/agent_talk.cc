// The user lent to the module that converses, with the keyboard and the script beside the ear.
#include <algorithm>
#include <utility>

#include "task_manager/platform/agent_platform.h"

namespace vxml {
namespace {

constexpr Millis kLongestTurn{300'000};
constexpr Millis kLook{500};

}  // namespace

bool AgentPlatform::HungUp() const {
  return hub_.gone() || std::ranges::any_of(heard_, [](const Input& input) {
           return input.kind == Input::Kind::kHangup;
         });
}

/// What both say stands in the transcript, as that of the document's own dialogue does.
void AgentPlatform::ReportTalk(bool user, const std::string& text) {
  ReportSentence();
  if (user) {
    JsonLine line;
    line.Text("mode", "voice").Text("utterance", text).Bool("match", true);
    return Report("result", line);
  }
  sentence_ = text;
  spoken_from_.reset();
  if (!options_.script) ReportSentence();
}

/// With a script a sentence is reported when it was said, as prompts are.
void AgentPlatform::ReportSentence() {
  const auto text = std::exchange(sentence_, std::nullopt);
  if (!text) return;
  JsonLine line;
  line.Text("text", *text).Bool("bargein", true);
  if (options_.script && spoken_from_) {
    line.Number("ms", static_cast<double>((spoken_to_ - *spoken_from_).count()));
  }
  ReportAt(spoken_from_.value_or(Now()), "prompt", line);
}

/// The next turn of a script, with those that interrupt its answer: all in one macro of the hub,
/// for a film's clock does not wait for this program.
void AgentPlatform::TalkFromScript() {
  auto command = Next();
  if (!command || command->kind == Command::Kind::kHangup) return Hear(Input::Kind::kHangup, {});
  if (command->kind == Command::Kind::kSilence) {
    Pause(talk_silence_);
    return talk_->Stop("silence");
  }
  if (command->kind != Command::Kind::kSay) return;  // keys mean nothing to a conversation
  auto steps = nlohmann::json::array({PauseStep(kReaction)});
  do {
    const std::string words = command->hypotheses.empty() ? "?" : command->hypotheses.front().text;
    talk_->Said();
    steps.push_back({{"request", "to @" + options_.ear + " set Input.text = " + words},
                     {"limit_ms", kMacroLimit.count()}});
    command = options_.script();
    if (!command || command->kind != Command::Kind::kSay || !command->at) break;
    steps.push_back(SpeakingStep());
    steps.push_back(PauseStep(*command->at));
  } while (true);
  next_ = command;
  const std::string macro = Macro("Talk");
  const bool said = hub_.Ask("to @AM-MCL def " + macro + " = " + JsonText(steps), kAnswer) &&
                    hub_.Ask("to @AM-MCL set " + macro + " = NOW", kLongestTurn);
  // An interruption finds no answer where the conversation has ended before.
  if (!said && !talk_->over()) Hear(Input::Kind::kHangup, {});
}

/// Words that cut off the prompts are the first of the conversation.
void AgentPlatform::HandOverHeard() {
  for (const Input& input : std::exchange(heard_, {})) {
    if (input.kind == Input::Kind::kHangup) heard_.push_back(input);
    if (input.kind != Input::Kind::kSpeech || input.hypotheses.empty()) continue;
    talk_->Said();
    hub_.Send("to @" + options_.chat + " set Input.text = " + input.hypotheses.front().text);
  }
}

/// Until something has changed for the conversation, at most kLook.
void AgentPlatform::AwaitTalk(Millis left) {
  const auto waits = [this] { return talk_->WaitsForUser() && !hearing_ && typed_waiting_ == 0; };
  // What a reply says of the end comes back to @CHAT by way of the hub: after an answer it is
  // there.
  if (waits()) static_cast<void>(hub_.Ask("to @" + options_.chat + " inq Busy", kAnswer));
  if (waits()) {
    if (options_.script) return TalkFromScript();
    hub_.LetCutIn(HubLink::CutIn::kNext);
    hub_.TakeTyped();
    if (TypedOver()) Hear(Input::Kind::kHangup, {});
  }
  const bool waited = waits();
  hub_.WaitFor([&] { return talk_->over() || HungUp() || waits() != waited; },
               std::min(left, kLook));
}

TalkResult AgentPlatform::Talk(const std::vector<Prompt>& prompts, const TalkRequest& request) {
  mark_.clear();
  // @CHAT listens without a grammar, and so are the words heard that cut off the prompts.
  static_cast<void>(hub_.Ask("to @" + options_.ear + " set Grammar = NONE", kAnswer));
  in_ear_.clear();
  hub_.LetCutIn(HubLink::CutIn::kNext);
  if (!Speaks(prompts, true)) return {.kind = TalkResult::Kind::kHangup};
  static_cast<void>(hub_.Ask(
      "to @AM set Subscribe = " + options_.ear + " " + options_.voice + " AM-MCL " + options_.chat,
      kAnswer));
  attends_ = false;
  talk_silence_ = request.silence;
  talk_.emplace(hub_, options_.chat,
                [this](bool user, const std::string& text) { ReportTalk(user, text); });
  // On a film's clock the waiting for silence is ours: that clock would pass over any limit of
  // somebody else's before the script's words come.
  talk_->Begin(request, options_.script ? Millis(0) : request.silence);
  HandOverHeard();
  const auto deadline = std::chrono::steady_clock::now() + request.max_time;
  while (!talk_->over() && !HungUp()) {
    const auto left = std::chrono::ceil<Millis>(deadline - std::chrono::steady_clock::now());
    if (left.count() > 0) {
      AwaitTalk(left);
    } else {
      talk_->Stop("maxtime");
    }
  }
  hub_.LetCutIn(HubLink::CutIn::kNone);
  const bool hung_up = HungUp();
  if (hung_up) talk_->Stop("hangup");
  ReportSentence();
  TalkResult result = talk_->Take();
  if (hung_up) result.kind = TalkResult::Kind::kHangup;
  talk_.reset();
  heard_.clear();
  return result;
}

}  // namespace vxml
