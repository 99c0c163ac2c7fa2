#include "task_manager/platform/agent_platform.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "task_manager/xml/node.h"

namespace vxml {
namespace {

constexpr Millis kAnswer{5000};
constexpr Millis kLongestSpeech{300'000};
constexpr Millis kReaction{500};
constexpr std::size_t kMaxText = 7000;  // the voice takes 8192 bytes
constexpr std::chrono::seconds kNodPause{2};

/// How a voice follows a feeling (property emotionspeak): JEIDA tags around the words.
struct Tone {
  std::string_view feeling;
  std::string_view tags;
  std::string_view close;
};
constexpr Tone kTones[] = {
    {"HAPPY", "<PITCH LEVEL=\"1.12\"><RATE SPEED=\"0.94\">", "</RATE></PITCH>"},
    {"SAD", "<PITCH LEVEL=\"0.92\"><RATE SPEED=\"1.2\">", "</RATE></PITCH>"},
    {"ANGRY", "<VOLUME LEVEL=\"1.3\"><RATE SPEED=\"0.9\">", "</RATE></VOLUME>"},
    {"SURPRISED", "<PITCH LEVEL=\"1.2\"><RATE SPEED=\"0.95\">", "</RATE></PITCH>"},
    {"FEARED", "<PITCH LEVEL=\"1.15\"><RATE SPEED=\"0.85\">", "</RATE></PITCH>"},
    {"DISGUSTED", "<PITCH LEVEL=\"0.95\"><RATE SPEED=\"1.1\">", "</RATE></PITCH>"},
};

/// The voice reads tags, so '<' and '&' of the words must not look like one.
std::string Words(const std::string& text) {
  std::string plain;
  for (const char c : text) plain += c == '<' || c == '>' ? ' ' : c;
  return plain;
}

}  // namespace

AgentPlatform::AgentPlatform(HubLink& hub, Options options)
    : hub_(hub), options_(std::move(options)) {
  const std::string& ear = options_.ear;
  hub_.client().On("Result", [this](const vm::Message& m) {
    if (m.from == options_.ear)
      heard_.push_back({Input::Kind::kSpeech, {{m.value, 1.0}}, "", {}, ""});
  });
  hub_.client().On("NoMatch", [this](const vm::Message& m) {
    if (m.from == options_.ear)
      heard_.push_back({Input::Kind::kSpeech, {{m.value, 1.0}}, "", {}, ""});
  });
  hub_.client().On("Listen.stat", [this](const vm::Message& m) {
    if (m.from == options_.ear) hearing_ = m.value == "SPEECH";
  });
  hub_.client().On("Result.partial", [this](const vm::Message& m) {
    const auto now = std::chrono::steady_clock::now();
    if (m.from != options_.ear || now - last_nod_ < kNodPause) return;
    last_nod_ = now;
    hub_.Send("to @" + options_.face + " set FaceMot = NOD 1");
  });
  hub_.client().On("Speak.mark", [this](const vm::Message& m) {
    std::size_t index = 0;
    const std::string_view name = std::string_view(m.value).substr(0, m.value.find(' '));
    if (m.from != options_.voice || !name.starts_with("d")) return;
    std::from_chars(name.data() + 1, name.data() + name.size(), index);
    while (acted_ <= index && acted_ < actions_.size()) Act(acted_++);
  });
  hub_.on_typed = [this](const std::string& line) { OnTyped(line); };
  static_cast<void>(
      hub_.Ask("to @AM set Subscribe = " + ear + " " + options_.voice + " AM-MCL", kAnswer));
  hub_.Send("to @" + options_.voice + " prop Speak.mark = AutoOutput");
  hub_.Send("to @" + ear + " set Grammar = NONE");
  static_cast<void>(hub_.Ask("to @" + ear + " set Run = START", kAnswer));
}

Millis AgentPlatform::Now() const {
  return std::chrono::duration_cast<Millis>(std::chrono::steady_clock::now() - start_);
}

void AgentPlatform::Report(std::string_view type, const JsonLine& fields) {
  if (!options_.write) return;
  JsonLine head;
  head.Number("t", static_cast<double>(Now().count())).Text("type", type);
  const std::string a = head.str();
  const std::string b = fields.str();
  options_.write(b == "{}" ? a : a.substr(0, a.size() - 1) + "," + b.substr(1));
}

void AgentPlatform::OnTyped(const std::string& line) {
  if (xml::IsBlank(line)) return;
  if (line[0] != '/') return hub_.Send("to @" + options_.ear + " set Input.text = " + line);
  auto command = ParseCommand(std::string_view(line).substr(1));
  if (!command) return;
  if (command->kind == Command::Kind::kDtmf) {
    heard_.push_back({Input::Kind::kDtmf, command->hypotheses, "", {}, ""});
  } else if (command->kind == Command::Kind::kHangup) {
    heard_.push_back({Input::Kind::kHangup, {}, "", {}, ""});
  } else if (command->kind == Command::Kind::kSilence) {
    heard_.push_back({Input::Kind::kSilence, {}, "", {}, ""});
  }
}

/// The prompt as one utterance: bookmarks where something else has to happen.
std::string AgentPlatform::Tagged(const Prompt& prompt) {
  std::string text;
  actions_.clear();
  acted_ = 0;
  bool words = false;
  for (const Segment& segment : prompt.segments) {
    switch (segment.kind) {
      case Segment::Kind::kText: {
        const Tone* tone = nullptr;
        for (const Tone& known : kTones) {
          if (known.feeling == segment.emotion) tone = &known;
        }
        if (!text.empty() && !text.ends_with(">")) text += ' ';
        if (text.ends_with(">")) text += ' ';
        text += tone ? std::string(tone->tags) + Words(segment.text) + std::string(tone->close)
                     : Words(segment.text);
        words = true;
        break;
      }
      case Segment::Kind::kPause:
        text += "<SILENCE MSEC=\"" + std::to_string(segment.pause.count()) + "\"/>";
        break;
      case Segment::Kind::kMark:
      case Segment::Kind::kCommand:
        if (segment.parallel) break;
        actions_.push_back((segment.kind == Segment::Kind::kMark ? "mark " : "") + segment.text);
        if (words) {
          text += "<BOOKMARK MARK=\"d" + std::to_string(actions_.size() - 1) + "\"/>";
        } else {
          Act(acted_++);  // before the first word: at once
        }
        break;
      case Segment::Kind::kAudio:
        actions_.push_back("to @SND set Play = " + segment.text);
        break;
    }
  }
  return words ? text.substr(0, kMaxText) : "";
}

void AgentPlatform::Act(std::size_t index) {
  const std::string& action = actions_[index];
  if (action.starts_with("mark ")) {
    mark_ = action.substr(5);
    mark_at_ = std::chrono::steady_clock::now();
    JsonLine line;
    line.Text("name", mark_);
    return Report("mark", line);
  }
  Native(action);
}

/// Commands beside the words: a macro of the hub that starts with the voice (the original's PAR).
void AgentPlatform::StartParallel(const Prompt& prompt) {
  std::string steps = std::exchange(beside_, "");
  for (const Segment& segment : prompt.segments) {
    if (segment.kind != Segment::Kind::kCommand || !segment.parallel) continue;
    if (segment.pause.count() > 0) {
      steps += ", {\"pause_ms\": " + std::to_string(segment.pause.count()) + "}";
    }
    steps += ", {\"send\": " + JsonQuote(segment.text) + "}";
  }
  if (steps.empty()) return;
  hub_.Send(
      "to @AM-MCL def DialogueBeside = [{\"wait\": {\"from\": \"AM-MCL\", \"slot\": "
      "\"Speak.stat\", "
      "\"value\": \"SPEAKING\"}, \"limit_ms\": 20000}" +
      steps + "]");
  hub_.Send("to @AM-MCL do DialogueBeside");
}

void AgentPlatform::Say(const Prompt& prompt, bool may_be_stopped) {
  JsonLine line;
  line.Text("text", prompt.text).Bool("bargein", prompt.bargein);
  if (!prompt.text.empty()) Report("prompt", line);
  const std::string text = Tagged(prompt);
  if (!text.empty()) {
    StartParallel(prompt);
    auto message = vm::ParseMessage("to @AM-MCL set Speak = " + text);
    bool done = false;
    bool failed = false;
    if (message) {
      hub_.client().Request(*message, [&](const vm::Result<std::string>& answer) {
        done = true;
        failed = !answer;
      });
      const auto stop = [&] { return done || (may_be_stopped && (hearing_ || !heard_.empty())); };
      hub_.WaitFor(stop, kLongestSpeech);
      if (!done) {
        static_cast<void>(hub_.Ask("to @AM-MCL set Speak = STOP", kAnswer));
        hub_.WaitFor([&] { return done; }, kAnswer);
        if (!done) hub_.client().Abandon("", {vm::Errc::kTimeout, "no end of speech", 0});
      }
    }
  }
  while (acted_ < actions_.size()) Act(acted_++);
}

bool AgentPlatform::Speaks(const std::vector<Prompt>& prompts, bool listening) {
  for (const Prompt& prompt : prompts) {
    if (!prompt.bargein || !listening) heard_.clear();
    Say(prompt, listening && prompt.bargein);
    if (!prompt.bargein) heard_.clear();
    if (listening && (hearing_ || !heard_.empty())) break;
    if (hub_.gone()) return false;
  }
  return !hub_.gone();
}

bool AgentPlatform::Play(const std::vector<Prompt>& prompts) { return Speaks(prompts, false); }

/// Time of the hub passes: a film's clock is virtual, so the machine's says nothing.
void AgentPlatform::Pause(Millis time) {
  const std::string steps = "[{\"pause_ms\": " + std::to_string(time.count()) + "}]";
  auto defined = hub_.Ask("to @AM-MCL def DialoguePause = " + steps, kAnswer);
  if (defined) static_cast<void>(hub_.Ask("to @AM-MCL set DialoguePause = NOW", time + kAnswer));
}

std::optional<Input> AgentPlatform::FromScript(const Listen& listen) {
  auto command = options_.script();
  Input input;
  if (!command || command->kind == Command::Kind::kHangup) {
    ran_out_ = ran_out_ || !command;
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
  if (!said) heard_.push_back({Input::Kind::kSpeech, {{words, 1.0}}, "", {}, ""});
  return {};
}

std::optional<Input> AgentPlatform::Taken() {
  if (heard_.empty()) return {};
  Input input = std::move(heard_.front());
  heard_.pop_front();
  if (!mark_.empty()) {
    input.mark = mark_;
    input.mark_time =
        std::chrono::duration_cast<Millis>(std::chrono::steady_clock::now() - mark_at_);
  }
  return input;
}

Input AgentPlatform::Collect(const std::vector<Prompt>& prompts, const Listen& listen) {
  mark_.clear();
  if (!Speaks(prompts, true)) return {Input::Kind::kHangup, {}, "", {}, ""};
  hub_.Send("to @" + options_.face + " set Gaze = 0 0");  // attends to the user
  if (options_.script && heard_.empty()) {
    if (auto input = FromScript(listen)) return *input;
  }
  const auto ready = [&] { return !heard_.empty() || hub_.typed_end(); };
  while (!ready() && !hub_.gone()) {
    if (!hub_.WaitFor([&] { return ready() || hearing_; }, listen.timeout)) break;
    if (!ready()) hub_.WaitFor(ready, listen.max_speech);
  }
  if (auto input = Taken()) return *input;
  Input input;
  input.kind = hub_.gone() || hub_.typed_end() ? Input::Kind::kHangup : Input::Kind::kSilence;
  return input;
}

RecordResult AgentPlatform::Record(const std::vector<Prompt>& prompts, const RecordRequest&) {
  Play(prompts);
  RecordResult result;
  result.kind = RecordResult::Kind::kUnsupported;
  return result;
}

TransferResult AgentPlatform::Transfer(const std::vector<Prompt>& prompts,
                                       const TransferRequest& request) {
  Play(prompts);
  TransferResult result;
  result.outcome = "error.unsupported.transfer." + request.type;
  return result;
}

void AgentPlatform::Native(const std::string& line) {
  JsonLine report;
  report.Text("line", line);
  Report("command", report);
  auto message = vm::ParseMessage(line);
  if (!message) return;
  // The original's module PAR: a list of commands and sleeps that starts with the next speech.
  if (message->to.size() == 1 && message->to[0] == "PAR") {
    double seconds = 0;
    const std::string& value = message->value;
    if (message->slot == "Init") {
      beside_.clear();
    } else if (value.starts_with("sleep ")) {
      std::from_chars(value.data() + 6, value.data() + value.size(), seconds);
      beside_ += ", {\"pause_ms\": " + std::to_string(static_cast<int>(seconds * 1000)) + "}";
    } else {
      beside_ += ", {\"send\": " + JsonQuote(value) + "}";
    }
    return;
  }
  hub_.Send(line);
}

void AgentPlatform::Fetching(const std::string& uri, bool begins) {
  static_cast<void>(uri);
  hub_.Send("to @" + options_.face + (begins ? " set Gaze = -8 14" : " set Gaze = 0 0"));
}

}  // namespace vxml
