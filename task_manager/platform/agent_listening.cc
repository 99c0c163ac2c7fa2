// The listening side: grammars to the ear, what is heard, typed or scripted.
#include <utility>

#include "task_manager/platform/agent_platform.h"
#include "vm_protocol/xml/node.h"

namespace vxml {
namespace {

constexpr std::size_t kMostGrammar = 12'000;  // the ear takes 16 KiB

/// The key that ends an input is no part of it, unless a grammar takes it so.
void EndKeys(Input& input, const Listen& listen) {
  if (input.kind != Input::Kind::kDtmf || input.hypotheses.empty()) return;
  std::string& keys = input.hypotheses.front().text;
  if (keys.size() < 2 || listen.termchar != keys.substr(keys.size() - 1)) return;
  if (listen.keys && listen.keys(keys).complete) return;
  input.termchar = listen.termchar;
  keys.pop_back();
}

}  // namespace

bool AgentPlatform::OnTyped(const std::string& line) {
  if (vm::xml::IsBlank(line)) return false;
  if (line[0] != '/') {
    auto message = vm::ParseMessage("to @" + options_.ear + " set Input.text = " + line);
    if (!message) return false;
    ++typed_waiting_;
    if (talk_) talk_->Said();
    hub_.client().Request(*message, [this](const vm::Result<std::string>& taken) {
      --typed_waiting_;
      if (!taken && talk_) talk_->NotTaken();
      if (!taken) hub_.LetCutIn(HubLink::CutIn::kNext);
    });
    return true;
  }
  auto command = ParseCommand(std::string_view(line).substr(1));
  if (!command) return false;
  if (command->kind == Command::Kind::kDtmf) {
    Hear(Input::Kind::kDtmf, command->hypotheses);
  } else if (command->kind == Command::Kind::kHangup) {
    Hear(Input::Kind::kHangup, {});
  } else if (command->kind == Command::Kind::kSilence) {
    Hear(Input::Kind::kSilence, {});
  } else {
    return false;
  }
  return true;
}

/// The active grammars, as far as the ear can hold them. What it cannot is heard freely and
/// matched here.
void AgentPlatform::UseGrammars(const Listen& listen) {
  const std::string text = listen.phrases ? listen.phrases(kMostGrammar) : "";
  if (text == in_ear_) return;
  const std::string to_ear = "to @" + options_.ear;
  bool loaded = false;
  if (!text.empty()) {
    const std::string name = "dialog_" + options_.name;
    loaded = hub_.Ask(to_ear + " set Grammar.load = " + name + " " + text, kAnswer).has_value() &&
             hub_.Ask(to_ear + " set Grammar = " + name, kAnswer).has_value();
  }
  if (!loaded) static_cast<void>(hub_.Ask(to_ear + " set Grammar = NONE", kAnswer));
  in_ear_ = text;
}

/// What somebody says while the agent speaks: `at` so much of the hub's time after it began to.
/// The hub itself stops the speech then: a film's clock does not wait for this program.
void AgentPlatform::Interrupt(const Command& command, const std::vector<Prompt>& prompts,
                              const Listen& listen) {
  const std::string words = command.hypotheses.empty() ? "?" : command.hypotheses.front().text;
  const bool keys = command.kind == Command::Kind::kDtmf;
  const bool spoken = !keys && command.kind != Command::Kind::kHangup;
  bool speaks = false;
  bool stops = true;
  for (const Prompt& prompt : prompts) {
    speaks = speaks || !prompt.text.empty();
    stops = stops && prompt.bargein &&
            (!prompt.hotword || !spoken || (listen.accepts && listen.accepts(words)));
  }
  auto steps = nlohmann::json::array();
  if (speaks) steps.push_back(SpeakingStep());
  steps.push_back(PauseStep(*command.at));
  if (spoken) {
    steps.push_back({{"request", "to @" + options_.ear + " set Input.text = " + words},
                     {"limit_ms", kMacroLimit.count()}});
  }
  if (speaks && stops) steps.push_back(SendStep("to @AM-MCL set Speak = STOP"));
  const std::string macro = Macro("Interrupt");
  if (!hub_.Ask("to @AM-MCL def " + macro + " = " + JsonText(steps), kAnswer)) return;
  auto message = vm::ParseMessage("to @AM-MCL set " + macro + " = NOW");
  if (!message) return;
  interrupting_ = true;
  hub_.client().Request(*message, [this, command, keys](const vm::Result<std::string>&) {
    interrupting_ = false;
    if (keys) Hear(Input::Kind::kDtmf, command.hypotheses);
    if (command.kind == Command::Kind::kHangup) Hear(Input::Kind::kHangup, {});
  });
}

/// Time of the hub passes: a film's clock is virtual, so the machine's says nothing.
void AgentPlatform::Pause(Millis time) {
  const std::string macro = Macro("Pause");
  const auto steps = nlohmann::json::array({PauseStep(time)});
  auto defined = hub_.Ask("to @AM-MCL def " + macro + " = " + JsonText(steps), kAnswer);
  if (defined) static_cast<void>(hub_.Ask("to @AM-MCL set " + macro + " = NOW", time + kAnswer));
}

std::optional<Command> AgentPlatform::Next() {
  if (next_) return std::exchange(next_, std::nullopt);
  auto command = options_.script();
  ran_out_ = ran_out_ || !command;
  return command;
}

void AgentPlatform::Hear(Input::Kind kind, std::vector<Hypothesis> hypotheses) {
  if (talk_ && kind == Input::Kind::kSpeech) return;  // @CHAT hears it, too
  Input input;
  input.kind = kind;
  input.hypotheses = std::move(hypotheses);
  if (kind == Input::Kind::kSpeech) AddSound(input);
  heard_.push_back(std::move(input));
}

std::optional<Input> AgentPlatform::FromScript(const std::optional<Command>& command,
                                               const Listen& listen) {
  Input input;
  if (!command || command->kind == Command::Kind::kHangup) {
    input.kind = Input::Kind::kHangup;
    return input;
  }
  const bool silent = command->kind == Command::Kind::kSilence;
  const Millis wait = silent ? listen.timeout : kReaction;
  Pause(wait);
  if (silent) return input;
  if (command->kind == Command::Kind::kDtmf) {
    input.kind = Input::Kind::kDtmf;
    input.hypotheses = command->hypotheses;
    return input;
  }
  const std::string words = command->hypotheses.empty() ? "?" : command->hypotheses.front().text;
  auto said = hub_.Ask("to @" + options_.ear + " set Input.text = " + words, Millis(60'000));
  if (!said) Hear(Input::Kind::kSpeech, {{words, 1.0}});
  return {};
}

std::optional<Input> AgentPlatform::Taken() {
  if (heard_.empty()) return {};
  Input input = std::move(heard_.front());
  heard_.pop_front();
  if (!mark_.empty()) {
    input.mark = mark_;
    input.mark_time = Now() - mark_at_;
  }
  return input;
}

/// The face looks at the user and listens, until the next prompt.
void AgentPlatform::Attend() {
  if (!attends_) return;
  hub_.Send("to @" + options_.face + " set Gaze = 0 0");
  SetLife("LISTENING");
}

/// A face of the original has no such slot, and one that is told to be still stays so.
void AgentPlatform::SetLife(const std::string& life) {
  if (life_.empty() || life_ == "OFF" || life == life_now_) return;
  life_now_ = life;
  hub_.Send("to @" + options_.face + " set Life = " + life);
}

Input AgentPlatform::Collect(const std::vector<Prompt>& prompts, const Listen& listen) {
  mark_.clear();
  UseGrammars(listen);
  KeepSounds(listen.keep_sound);
  attends_ = listen.attention;
  std::optional<Command> command = options_.script ? Next() : std::nullopt;
  const bool interrupts = command && command->at;
  if (interrupts) Interrupt(*command, prompts, listen);
  Input input;
  input.kind = Input::Kind::kHangup;
  hub_.LetCutIn(HubLink::CutIn::kNext);
  if (!Speaks(prompts, true)) return input;
  Attend();
  if (interrupts && !interrupting_ && heard_.empty() && !hearing_) {  // a prompt without bargein
    JsonLine line;
    line.Text("input", command->hypotheses.empty() ? "" : command->hypotheses.front().text);
    line.Text("why", "bargein");
    Report("ignored", line);
    command = Next();
  }
  const bool on_its_way = interrupts && (interrupting_ || hearing_);
  if (options_.script && heard_.empty() && !on_its_way) {
    if (auto scripted = FromScript(command, listen)) {
      EndKeys(*scripted, listen);
      return *scripted;
    }
  } else if (options_.script && !interrupts) {
    next_ = command;  // somebody else spoke first
  }
  if (heard_.empty() && !hearing_) hub_.TakeTyped();
  const auto ready = [&] { return !heard_.empty() || TypedOver(); };
  while (!ready() && !hub_.gone()) {
    if (!hub_.WaitFor([&] { return ready() || hearing_; }, listen.timeout)) break;
    if (!ready()) hub_.WaitFor(ready, listen.max_speech);
  }
  hub_.LetCutIn(HubLink::CutIn::kNone);
  if (auto taken = Taken()) {
    EndKeys(*taken, listen);
    return *taken;
  }
  input.kind = hub_.gone() || TypedOver() ? Input::Kind::kHangup : Input::Kind::kSilence;
  return input;
}

}  // namespace vxml
