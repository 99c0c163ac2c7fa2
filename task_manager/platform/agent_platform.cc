#include "task_manager/platform/agent_platform.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "task_manager/document/values.h"
#include "task_manager/fetch/uri.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/xml/node.h"

namespace vxml {
namespace {

constexpr Millis kLongestSpeech{300'000};
constexpr Millis kSoundModule{500};  // the hub refuses at once what it does not know
constexpr std::chrono::seconds kNodPause{2};
/// Bytes of one utterance's words: the voice takes 8192 with the tags between them.
constexpr std::size_t kMaxWords = 3000;

/// Words of more than kMaxWords in parts, at blanks if there are some.
std::vector<Segment> PartsOf(const Segment& segment) {
  std::vector<Segment> parts{segment};
  while (segment.kind == Segment::Kind::kText && parts.back().text.size() > kMaxWords) {
    std::string& text = parts.back().text;
    std::size_t end = vm::CutUtf8(text, kMaxWords).size();
    if (const std::size_t blank = text.rfind(' ', end); blank != std::string::npos && blank > 0) {
      end = blank;
    }
    Segment rest = segment;
    rest.text = text.substr(end);
    text.erase(end);
    parts.push_back(std::move(rest));
  }
  return parts;
}

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
    if (m.from == options_.ear) Hear(Input::Kind::kSpeech, {{m.value, 1.0}});
  });
  hub_.client().On("NoMatch", [this](const vm::Message& m) {
    if (m.from == options_.ear) Hear(Input::Kind::kSpeech, {{m.value, 1.0}});
  });
  hub_.client().On("Listen.stat", [this](const vm::Message& m) {
    if (m.from == options_.ear) hearing_ = m.value == "SPEECH";
  });
  for (const char* const slot : {"Busy", "Heard", "Reply.sentence", "Reply", "Talk.over"}) {
    hub_.client().On(slot, [this](const vm::Message& m) {
      if (talk_ && m.from == options_.chat) talk_->OnReport(m);
    });
  }
  hub_.client().On("Result.sound", [this](const vm::Message& m) {
    if (m.from == options_.ear) OnSound(m.value);
  });
  hub_.client().On("Result.partial", [this](const vm::Message& m) {
    const auto now = std::chrono::steady_clock::now();
    if (m.from != options_.ear || !attends_ || now - last_nod_ < kNodPause) return;
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
  hub_.client().On("Speak.stat", [this](const vm::Message& m) {
    if (m.from != options_.voice) return;
    if (m.value == "SPEAKING" && !spoken_from_) spoken_from_ = Now();
    if (m.value == "IDLE") {
      spoken_to_ = Now();
      if (talk_) ReportSentence();
    }
  });
  hub_.on_typed = [this](const std::string& line) { return OnTyped(line); };
  static_cast<void>(
      hub_.Ask("to @AM set Subscribe = " + ear + " " + options_.voice + " AM-MCL", kAnswer));
  hub_.Send("to @" + options_.voice + " prop Speak.mark = AutoOutput");
  hub_.Send("to @" + ear + " set Grammar = NONE");
  static_cast<void>(hub_.Ask("to @" + ear + " set Run = START", kAnswer));
  life_ = life_now_ = hub_.Ask("to @" + options_.face + " inq Life", kSoundModule).value_or("");
  has_sound_module_ = hub_.Ask("to @SND inq Slots", kSoundModule).has_value();
  if (options_.script) hub_.WatchTime();
  StartTime();
}

Millis AgentPlatform::Now() const {
  const auto machine = std::chrono::steady_clock::now().time_since_epoch();
  return hub_.hub_time().value_or(std::chrono::duration_cast<Millis>(machine)) - zero_;
}

void AgentPlatform::StartTime() { zero_ += Now(); }

void AgentPlatform::Report(std::string_view type, const JsonLine& fields) {
  ReportAt(Now(), type, fields);
}

void AgentPlatform::ReportAt(Millis time, std::string_view type, const JsonLine& fields) {
  if (!options_.write) return;
  JsonLine head;
  head.Number("t", static_cast<double>(time.count())).Text("type", type).Add(fields);
  if (saying_) return held_.push_back(head.str());
  options_.write(head.str());
}

void AgentPlatform::ReportSaid(const Prompt& prompt, bool cut) {
  saying_ = false;
  auto held = std::exchange(held_, {});
  JsonLine line;
  line.Text("text", prompt.text).Bool("bargein", prompt.bargein);
  if (const auto feelings = prompt.Feelings(); !feelings.empty()) line.List("feelings", feelings);
  if (options_.script && spoken_from_) {
    line.Number(cut ? "heard_ms" : "ms", static_cast<double>((spoken_to_ - *spoken_from_).count()));
  }
  if (!prompt.text.empty()) ReportAt(spoken_from_.value_or(Now()), "prompt", line);
  if (!options_.write) return;
  for (const std::string& each : held) options_.write(each);
}

/// The prompt as one utterance: bookmarks where something else has to happen.
std::string AgentPlatform::Tagged(const std::vector<Segment>& segments) {
  std::string text;
  actions_.clear();
  acted_ = 0;
  bool words = false;
  for (const Segment& segment : segments) {
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
        actions_.push_back({segment.kind == Segment::Kind::kMark, segment.text, segment.pause});
        if (words) {
          text += "<BOOKMARK MARK=\"d" + std::to_string(actions_.size() - 1) + "\"/>";
        } else {
          Act(acted_++);  // before the first word: at once
        }
        break;
      case Segment::Kind::kAudio:  // spoken apart
        break;
    }
  }
  return words ? text : "";
}

void AgentPlatform::Act(std::size_t index) {
  const Action& action = actions_[index];
  if (action.is_mark) {
    mark_ = action.text;
    mark_at_ = Now();
    JsonLine line;
    line.Text("name", mark_);
    return Report("mark", line);
  }
  if (action.delay.count() > 0) {
    const std::string macro = Macro("Later" + std::to_string(index));
    hub_.Send("to @AM-MCL def " + macro + " = " +
              JsonText({PauseStep(action.delay), SendStep(action.text)}));
    return hub_.Send("to @AM-MCL do " + macro);
  }
  Native(action.text);
}

nlohmann::json AgentPlatform::PauseStep(Millis time) { return {{"pause_ms", time.count()}}; }
nlohmann::json AgentPlatform::SendStep(const std::string& line) { return {{"send", line}}; }
nlohmann::json AgentPlatform::SpeakingStep() const {
  return {{"wait", {{"from", options_.voice}, {"slot", "Speak.stat"}, {"value", "SPEAKING"}}},
          {"limit_ms", kMacroLimit.count()}};
}

std::string AgentPlatform::Macro(const std::string& purpose) {
  return *macros_.insert("Dialogue" + purpose + "." + options_.name).first;
}

/// Commands beside the words: a macro of the hub that starts with the voice (the original's PAR).
void AgentPlatform::StartParallel(const Prompt& prompt) {
  nlohmann::json steps = std::exchange(beside_, nlohmann::json::array());
  for (const Segment& segment : prompt.segments) {
    if (segment.kind != Segment::Kind::kCommand || !segment.parallel) continue;
    if (segment.pause.count() > 0) steps.push_back(PauseStep(segment.pause));
    steps.push_back(SendStep(segment.text));
  }
  if (steps.empty()) return;
  steps.insert(steps.begin(), SpeakingStep());
  const std::string macro = Macro("Beside");
  hub_.Send("to @AM-MCL def " + macro + " = " + JsonText(steps));
  hub_.Send("to @AM-MCL do " + macro);
}

/// One utterance, to its end or until somebody speaks. False: it was stopped, or failed.
bool AgentPlatform::Utter(const std::string& text, bool may_be_stopped) {
  auto message = vm::ParseMessage("to @AM-MCL set Speak = " + text);
  if (!message) return false;
  bool done = false;
  bool failed = false;
  hub_.client().Request(*message, [&](const vm::Result<std::string>& answer) {
    done = true;
    failed = !answer;
  });
  const auto heard = [&] { return may_be_stopped && (hearing_ || !heard_.empty()); };
  hub_.WaitFor([&] { return done || heard(); }, kLongestSpeech);
  const bool finished = done;
  if (!done) {
    static_cast<void>(hub_.Ask("to @AM-MCL set Speak = STOP", kAnswer));
    hub_.WaitFor([&] { return done; }, kAnswer);
    if (!done) hub_.client().Abandon("", {vm::Errc::kTimeout, "no end of speech", 0});
  }
  return finished && !failed;
}

/// A sound file, by the voice: it plays what the listener is to hear, also in films.
void AgentPlatform::PlayFile(const std::string& file, bool may_be_stopped) {
  const std::string path = fetch::PathOf(file).value_or(file);
  if (!path.starts_with("/")) return;  // builtin: has none
  hub_.Send("tell start " + path);
  Utter("<speak><audio src=\"" + vm::xml::Escape(path) + "\"/></speak>", may_be_stopped);
  hub_.Send("tell end " + path);
}

void AgentPlatform::PlaySound(const Segment& segment, bool may_be_stopped) {
  if (const auto found = recordings_.find(segment.text); found != recordings_.end()) {
    return PlayFile(found->second, may_be_stopped);
  }
  if (!segment.sound) return PlayFile(segment.text, may_be_stopped);
  const auto file = sounds_kept_.FileOf(segment.text, *segment.sound);
  if (file) PlayFile(*file, may_be_stopped);
}

/// Words in one utterance as far as no sound file stands between them.
void AgentPlatform::Say(const Prompt& prompt, bool may_be_stopped) {
  spoken_from_.reset();
  saying_ = options_.script != nullptr;
  if (!saying_) ReportSaid(prompt, false);
  StartParallel(prompt);
  bool cut = false;
  const auto stopped = [&] { return cut || (may_be_stopped && (hearing_ || !heard_.empty())); };
  std::vector<Segment> piece;
  const auto end_piece = [&] {
    const std::string text = Tagged(std::exchange(piece, {}));
    if (!text.empty() && !stopped()) cut = !Utter(text, may_be_stopped);
    for (; acted_ < actions_.size(); ++acted_) {
      // Of what was not spoken any more commands are still carried out, so that the face comes to
      // rest, but no mark was reached.
      if (!stopped() || !actions_[acted_].is_mark) Act(acted_);
    }
    while (!sounds_.empty() && !stopped()) {
      const std::string file = std::move(sounds_.front());
      sounds_.pop_front();
      PlayFile(file, may_be_stopped);
    }
  };
  std::size_t bytes = 0;
  for (const Segment& segment : prompt.segments) {
    if (segment.kind == Segment::Kind::kAudio) {
      end_piece();
      bytes = 0;
      if (!stopped()) PlaySound(segment, may_be_stopped);
      continue;
    }
    for (Segment& part : PartsOf(segment)) {
      if (bytes + part.text.size() > kMaxWords) {
        end_piece();
        bytes = 0;
      }
      bytes += part.text.size();
      piece.push_back(std::move(part));
    }
  }
  end_piece();
  if (saying_) ReportSaid(prompt, cut);
}

bool AgentPlatform::Speaks(const std::vector<Prompt>& prompts, bool listening) {
  bool silent = false;
  if (!prompts.empty()) SetLife(life_);
  for (const Prompt& prompt : prompts) {
    if (silent) {
      for (const Segment& segment : prompt.segments) {
        if (segment.native) Native(segment.text);
      }
      continue;
    }
    if (!prompt.bargein || !listening) heard_.clear();
    Say(prompt, listening && prompt.bargein);
    if (!prompt.bargein) heard_.clear();
    silent = listening && (hearing_ || !heard_.empty());
    if (hub_.gone()) return false;
  }
  return !hub_.gone();
}

bool AgentPlatform::Play(const std::vector<Prompt>& prompts) { return Speaks(prompts, false); }

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
  // The original's module SND was a part of its dialogue manager, and so it is here.
  if (message->to.size() == 1 && message->to[0] == "SND" && !has_sound_module_) {
    if (message->slot == "Play") sounds_.push_back(message->value);
    return;
  }
  // The original's module PAR: a list of commands and sleeps that starts with the next speech.
  if (message->to.size() == 1 && message->to[0] == "PAR") {
    const std::string& value = message->value;
    if (message->slot == "Init") {
      beside_ = nlohmann::json::array();
    } else if (value.starts_with("sleep ")) {
      const double seconds = NumberIn(value.substr(6), 0, 600, 0);
      beside_.push_back(PauseStep(Millis(static_cast<long long>(seconds * 1000))));
    } else {
      beside_.push_back(SendStep(value));
    }
    return;
  }
  hub_.Send(line);
}

void AgentPlatform::Fetching(const std::string& uri, bool begins) {
  static_cast<void>(uri);
  hub_.Send("to @" + options_.face + (begins ? " set Gaze = -8 14" : " set Gaze = 0 0"));
  hub_.Flush();  // the fetch itself does not look for news
}

}  // namespace vxml
