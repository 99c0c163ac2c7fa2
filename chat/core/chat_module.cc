#include "chat/core/chat_module.h"

#include <algorithm>
#include <utility>

#include "vm_protocol/core/utf8.h"

namespace chat {
namespace {

using std::chrono::milliseconds;
using vm::Errc;

/// Who says nothing to our first question for so long is no hub: a person at a terminal, a script.
constexpr vm::Time kHubLimit = milliseconds(1000);
/// A sentence that seems complete is spoken after that, though nothing has followed yet.
constexpr vm::Time kCutPause = milliseconds(150);
/// Of silence before the first sound of a reply: enough for lips to open, and nobody waits longer.
constexpr int kLeadMs = 60;
constexpr const char* kHubName = "AM";
constexpr vm::Time kAnswer = milliseconds(5000);
constexpr vm::Time kNodPause = milliseconds(2000);
constexpr std::size_t kMaxShown = 32 << 10;  // bytes of a reply in one line
constexpr std::size_t kMaxWaiting = 8;
// A model that thinks before it answers may have used its tokens up by that.
const ModelFailure kWithoutWords{
    .trouble = Trouble::kBroken,
    .error = {
        Errc::kUnavailable,
        "the model answered without a word; one that thinks first may need more Model.tokens"}};

const char* NameOf(Trouble trouble) {
  static constexpr const char* kNames[] = {"away", "refused", "busy", "late", "broken", "long"};
  return kNames[static_cast<std::size_t>(trouble)];
}

bool IsJapanese(std::string_view text) {
  return std::ranges::any_of(vm::SignsOf(text), [](char32_t sign) {
    return (sign >= 0x3040 && sign <= 0x30FF) || (sign >= 0x4E00 && sign <= 0x9FFF) ||
           (sign >= 0xFF66 && sign <= 0xFF9D);
  });
}

std::string With(std::string text, std::string_view name, const std::string& value) {
  for (std::size_t at = text.find(name); at != std::string::npos;
       at = text.find(name, at + value.size()))
    text.replace(at, name.size(), value);
  return text;
}

std::string Ms(vm::Time time) {
  return std::to_string(std::chrono::duration_cast<milliseconds>(time).count());
}

}  // namespace

ChatModule::ChatModule(vm::Scheduler& clock, vm::HttpTransport& transport, Options options)
    : clock_(clock),
      options_(std::move(options)),
      slots_("CHAT"),
      hub_(clock, slots_),
      speaker_(clock, hub_, {.voice = options_.voice, .macros = "AM-MCL"},
               {.begins =
                    [this](const std::string& text) {
                      slots_.Report("Reply.sentence", text);
                      if (slots_.Value("Busy") == "SPEAKING") return;
                      SetBusy("SPEAKING");
                      Perform(options_.tags.AtState("SPEAKS", life_));
                    },
                .sounds =
                    [this] {
                      if (!turn_ || turn_->sound) return;
                      turn_->sound = clock_.Now();
                      ReportTimes();
                    },
                .failed =
                    [this](const vm::Error& error) {
                      if (!turn_ || std::exchange(turn_->unspoken, true)) return;
                      slots_.ReportError("Say", error);
                    },
                .done = [this] { EndTurn(); },
                .stopped =
                    [this] {
                      thinker_.Cancel();
                      if (turn_) turn_->stopped = true;
                      EndTurn();
                    }}),
      thinker_(clock, transport, hub_, options_.endpoint) {
  vm::DeclareCommonSlots(slots_, {.module_version = options_.module_version,
                                  .protocol_version = "Galatea protocol 1.0",
                                  .on_exit = [this] { exit_requested_ = true; }});
  DeclareInput();
  DeclareModel();
  DeclareHistory();
  DeclareReports();
  DeclareTalk();
  slots_.set_on_heard([this](const vm::Message& message) { OnHeard(message); });
  hub_timer_ = clock_.Post([this] {
    hub_timer_ = 0;
    MeetHub();
  });
}

ChatModule::~ChatModule() { Shutdown(); }

void ChatModule::Shutdown() {
  thinker_.Cancel();
  for (vm::TimerId* const timer : {&cut_timer_, &hub_timer_, &talk_timer_})
    clock_.Cancel(std::exchange(*timer, 0));
}

// --- meeting the hub

void ChatModule::MeetHub() {
  hub_.Ask(vm::To(kHubName, vm::Set("Subscribe", Subscriptions())), kHubLimit,
           [this](const vm::Result<std::string>& answer) { OnHubAnswer(answer); });
}

/// The hub's own events tell who has gone.
std::string ChatModule::Subscriptions() const {
  const bool watches = talk_ && !talk_->borrower.empty();
  return options_.ear + " " + options_.voice + (watches ? std::string(" ") + kHubName : "");
}

void ChatModule::OnHubAnswer(const vm::Result<std::string>& answer) {
  const bool alone = !answer && answer.error().code == Errc::kTimeout;
  if (!answer && !alone) slots_.ReportError("Listen", answer.error());
  hub_state_ = alone ? HubState::kAlone : HubState::kThere;
  speaker_.set_voiceless(alone);
  if (!alone) {
    PrepareVoice();
    hub_.Ask(vm::To(options_.face, vm::Inq("Life")), milliseconds(5000),
             [this](const vm::Result<std::string>& life) {
               life_ = life.value_or("");
               if (!turn_ && Listens()) Perform(options_.tags.AtState("WAITS", life_));
             });
    if (UsesModel()) thinker_.LearnSlots();
    StartEar();
  }
  TakeWaiting();
}

void ChatModule::PrepareVoice() {
  hub_.Say(
      vm::To(options_.voice,
             {{}, "", vm::Command::kProp, "", "Speak.mark", vm::Relation::kAssign, "AutoOutput"}));
  hub_.Say(vm::To(options_.voice, vm::Set("Text.lead", std::to_string(kLeadMs))));
}

void ChatModule::StartEar() {
  if (hub_state_ != HubState::kThere || !Listens()) return;
  hub_.Say(vm::To(options_.ear, vm::Set("Grammar", "NONE")));
  AskForHaste(true);
  hub_.Say(vm::To(options_.ear, vm::Set("Run", "START")));
}

/// In conversation whole phrases are answered after a short silence. An ear that cannot tell them
/// waits as ever.
void ChatModule::AskForHaste(bool haste) {
  hub_.Ask(vm::To(options_.ear, vm::Inq("Slots")), kAnswer,
           [this, haste](const vm::Result<std::string>& known) {
             if (!known || !(" " + *known + " ").contains(" Listen.complete ")) return;
             const std::string ms = haste ? slots_.Value("Listen.pause") : "0";
             hub_.Say(vm::To(options_.ear, vm::Set("Listen.complete", ms)));
           });
}

void ChatModule::OnHeard(const vm::Message& message) {
  hub_.Hear(message);
  if (message.command == vm::Command::kTell && message.from == kHubName && talk_ &&
      message.value.starts_with("@" + talk_->borrower + " has gone")) {
    return OnBorrowerGone();
  }
  if (message.command != vm::Command::kRep || !message.tag.empty()) return;
  // One that was started anew has forgotten what it was told.
  const bool anew = message.slot == "Run" && message.value == "LIVE";
  if (message.from == options_.voice) {
    if (anew) PrepareVoice();
    speaker_.OnVoice(message);
  }
  if (message.from != options_.ear) return;
  if (anew) StartEar();
  if (Listens()) OnEar(message);
}

void ChatModule::OnEar(const vm::Message& message) {
  const bool deaf = turn_ && slots_.Value("BargeIn") == "OFF";
  if (deaf) return;
  if (message.slot == "Listen.stat" && message.value == "SPEECH") {
    clock_.Cancel(std::exchange(talk_timer_, 0));
    Interrupt();
  } else if (message.slot == "Listen.stat" && talk_timer_ == 0) {
    WaitForTalk();
  } else if (message.slot == "Result.partial") {
    Interrupt();
    if (last_nod_ && clock_.Now() - *last_nod_ < kNodPause) return;
    last_nod_ = clock_.Now();
    Perform(options_.tags.AtState("HEARS", life_));
  } else if (message.slot == "Result" || message.slot == "NoMatch") {
    if (message.value.empty()) return WaitForTalk();
    // Nobody waits for an answer.
    Take({message.value, false, vm::Reply([this](const vm::Result<std::string>& done) {
            if (!done && done.error().code != Errc::kStopped)
              slots_.ReportError("Model", done.error());
          })});
  }
}

// --- a turn

void ChatModule::Take(Input input) {
  if (input.text.size() > kMaxInput) {
    return input.reply.Fail({Errc::kTooLong,
                             "the text has " + std::to_string(input.text.size()) +
                                 " bytes, expected at most " + std::to_string(kMaxInput),
                             0});
  }
  if (hub_state_ != HubState::kUnknown && !turn_) return Begin(std::move(input));
  // What is said while the turn before still ends is said together with what comes after it.
  if (!waiting_.empty() && waiting_.back().as_it_is == input.as_it_is &&
      waiting_.back().text.size() + input.text.size() < kMaxInput) {
    waiting_.back().reply.Fail({Errc::kStopped, "taken together with what was said after it", 0});
    input.text = waiting_.back().text + " " + input.text;
    waiting_.pop_back();
  }
  if (waiting_.size() >= kMaxWaiting) {
    return input.reply.Fail({Errc::kLimit, "too much waits to be said", 0});
  }
  waiting_.push_back(std::move(input));
  Interrupt();
}

void ChatModule::Begin(Input input) {
  clock_.Cancel(std::exchange(talk_timer_, 0));
  turn_.emplace(Turn{.input = std::move(input), .began = clock_.Now()});
  reader_.emplace(options_.tags);
  cutter_.emplace(options_.abbreviations);
  speaker_.Begin();
  if (turn_->input.as_it_is) {
    const std::string text = turn_->input.text;
    OnWords(text);
    return OnThought({});
  }
  history_.AddUser(turn_->input.text);
  slots_.Report("Heard", turn_->input.text);
  if (talk_) {
    ++talk_->turns;
    talk_->last = turn_->input.text;
  }
  SetBusy("THINKING");
  if (talk_ && talk_->end_phrases.FoundIn(talk_->last)) {
    talk_->ending = "ENDED";
    return speaker_.NoMore();
  }
  Think();
}

std::string ChatModule::LanguageOf(const std::string& text) const {
  const std::string chosen = slots_.Value("Language");
  if (chosen != "AUTO") return chosen;
  return IsJapanese(text) ? "ja" : "en";
}

Thinker::Settings ChatModule::ThinkerSettings() const {
  std::string system = With(options_.prompt, "$agent", options_.agent);
  const auto add = [&system](const std::string& text) {
    if (!text.empty()) system += (system.empty() ? "" : "\n") + text;
  };
  add(slots_.Value("Persona"));
  if (talk_ && !talk_->goal.empty()) add(With(options_.talk, "$goal", talk_->goal));
  return {.model = slots_.Value("Model"),
          .system = std::move(system),
          .limits = {.whole = std::chrono::seconds(Number("Model.seconds")),
                     .stall = std::chrono::seconds(Number("Model.stall")),
                     .reply_bytes = static_cast<std::size_t>(Number("Model.bytes"))},
          .tokens = Number("Model.tokens"),
          .rounds = Number("Tools.rounds")};
}

void ChatModule::Think() {
  if (UsesModel()) {
    Perform(options_.tags.AtState("THINKS", life_));
    return thinker_.Start(history_, ThinkerSettings(),
                          {.began = [this] { turn_->words = clock_.Now(); },
                           .words = [this](const std::string& words) { OnWords(words); },
                           .end =
                               [this](const std::optional<ModelFailure>& failure) {
                                 OnThought(failure || turn_->words ? failure : kWithoutWords);
                               }});
  }
  const std::string language = LanguageOf(turn_->input.text);
  std::string answer;
  const auto spoken = std::ranges::find(options_.rules, language, &Rules::language);
  if (!options_.rules.empty()) {
    Rules& rules = spoken == options_.rules.end() ? options_.rules.front() : *spoken;
    answer = rules.Answer(turn_->input.text, options_.agent, options_.wall_clock());
  }
  turn_->words = clock_.Now();
  OnWords(answer);
  OnThought({});
}

void ChatModule::OnWords(const std::string& words) {
  for (TagReader::Item& item : reader_->Feed(words)) {
    if (const auto* const text = std::get_if<std::string>(&item)) {
      cutter_->Feed(*text);
    } else {
      cutter_->Mark(std::move(std::get<Cue>(item)));
    }
  }
  Speak(cutter_->Take());
  clock_.Cancel(std::exchange(cut_timer_, 0));
  if (!cutter_->WouldEnd()) return;
  cut_timer_ = clock_.After(kCutPause, [this] {
    cut_timer_ = 0;
    Speak(cutter_->Flush());
  });
}

void ChatModule::Speak(std::vector<Sentence> sentences, bool counts) {
  for (Sentence& sentence : sentences) {
    if (turn_ && !turn_->sentence && sentence.HasWords()) turn_->sentence = clock_.Now();
    speaker_.Add(std::move(sentence), counts);
  }
}

void ChatModule::OnThought(const std::optional<ModelFailure>& failure) {
  clock_.Cancel(std::exchange(cut_timer_, 0));
  for (TagReader::Item& item : reader_->Flush()) {
    if (const auto* const text = std::get_if<std::string>(&item)) cutter_->Feed(*text);
  }
  Speak(cutter_->Flush());
  if (failure) {
    turn_->error = failure->error;
    Apologise(failure->trouble);
  }
  speaker_.NoMore();
}

void ChatModule::Apologise(Trouble trouble) {
  if (slots_.Value("Apology") == "OFF") return;
  const std::string text = options_.apologies.For(LanguageOf(turn_->input.text), NameOf(trouble));
  TagReader reader(options_.tags);
  SentenceCutter cutter(options_.abbreviations);
  auto items = reader.Feed(text);
  for (TagReader::Item& item : reader.Flush()) items.push_back(std::move(item));
  for (TagReader::Item& item : items) {
    if (const auto* const words = std::get_if<std::string>(&item)) {
      cutter.Feed(*words);
    } else {
      cutter.Mark(std::move(std::get<Cue>(item)));
    }
  }
  Speak(cutter.Flush(), false);
}

/// Somebody speaks, or wants silence.
void ChatModule::Interrupt() {
  if (!turn_ || turn_->stopped) return;
  turn_->stopped = true;
  thinker_.Cancel();
  clock_.Cancel(std::exchange(cut_timer_, 0));
  speaker_.Stop([this] { EndTurn(); });
}

void ChatModule::EndTurn() {
  if (!turn_) return;
  const Turn turn = std::move(*turn_);
  turn_.reset();
  clock_.Cancel(std::exchange(cut_timer_, 0));
  history_.AddAgent(speaker_.heard());
  // The user has been told that there is no answer, so the next request must not ask it again.
  if (turn.error) history_.DropUnanswered();
  const std::string heard(vm::CutUtf8(speaker_.heard(), kMaxShown));
  slots_.Report("Reply", heard);
  SetBusy("IDLE");
  if (Listens()) Perform(options_.tags.AtState("WAITS", life_));
  if (turn.stopped) {
    turn.input.reply.Fail({Errc::kStopped, "stopped after: " + heard, 0});
  } else if (turn.error) {
    turn.input.reply.Fail(*turn.error);
    if (talk_) FailTalk(*turn.error);
  } else {
    turn.input.reply.Ok(heard);
  }
  TakeWaiting();
  WaitForTalk();
}

void ChatModule::TakeWaiting() {
  if (turn_ || waiting_.empty()) return;
  Input next = std::move(waiting_.front());
  waiting_.erase(waiting_.begin());
  Begin(std::move(next));
}

void ChatModule::ReportTimes() {
  const auto since = [this](const std::optional<vm::Time>& time) {
    return time ? Ms(*time - turn_->began) : std::string("-");
  };
  slots_.Report("Reply.times", "words=" + since(turn_->words) + " sentence=" +
                                   since(turn_->sentence) + " sound=" + since(turn_->sound));
}

void ChatModule::SetBusy(const std::string& state) {
  if (slots_.Value("Busy") != state) slots_.Report("Busy", state);
}

/// A face that is told to be still, or knows no life of its own, stays as it is.
void ChatModule::Perform(const Cue& cue) {
  if (life_.empty() || life_ == "OFF") return;
  for (const vm::Message& message : cue) hub_.Say(message);
}

// --- a conversation lent to a dialogue

void ChatModule::StartTalk(const vm::SetValue& value, const vm::Reply& reply) {
  const std::string& first = value.word(0);
  if (first == "STOP" || first == "END") {
    reply.Ok(value.text);
    if (!talk_) return;
    if (first == "END" && value.size() > 1 && value.word(1) != "-")
      slots_.Report("Talk.result", value.word(1));
    talk_->ending = first == "END" ? "ENDED" : "STOPPED";
    if (!turn_) EndTalk(talk_->ending);
    return;
  }
  if (talk_) return reply.Fail({Errc::kBusy, "a conversation is lent already; Talk = STOP", 0});
  std::string borrower = value.size() > 2 ? value.word(2) : "";
  if (borrower.starts_with('@')) borrower.erase(0, 1);
  if (!borrower.empty() && !vm::IsModuleName(borrower))
    return reply.Fail({Errc::kBadValue, "found '" + borrower + "', expected a module's name", 0});
  talk_.emplace(
      Talk{.reply = reply,
           .most = static_cast<int>(value.number(0)),
           .silence = milliseconds(value.size() > 1 ? static_cast<long>(value.number(1)) : 0),
           .borrower = std::move(borrower),
           .goal = slots_.Value("Talk.goal"),
           .end_phrases = EndPhrases(slots_.Value("Talk.end"))});
  slots_.Report("Talk.result", "");
  // Of whoever waits for no answer the hub sees at once that it has gone.
  if (!talk_->borrower.empty()) reply.Ok("LENT");
  WatchBorrower();
  StartEar();
  WaitForTalk();
}

/// A borrower that ends without having taken the user back must not keep the conversation. It may
/// have gone before the hub tells us of such things, so the hub is asked, too.
void ChatModule::WatchBorrower() {
  if (talk_->borrower.empty() || hub_state_ != HubState::kThere) return;
  hub_.Say(vm::To(kHubName, vm::Set("Subscribe", Subscriptions())));
  hub_.Ask(vm::To(kHubName, vm::Inq("Modules")), kAnswer,
           [this, name = talk_->borrower](const vm::Result<std::string>& there) {
             if (!there || !talk_ || talk_->borrower != name) return;
             if (!(" " + *there + " ").contains(" " + name + " ")) OnBorrowerGone();
           });
}

void ChatModule::OnBorrowerGone() {
  talk_->ending = "STOPPED";
  Interrupt();
  if (!turn_) EndTalk(talk_->ending);
}

/// The user's turn, in a conversation that is lent: it ends with the last turn, or in silence.
void ChatModule::WaitForTalk() {
  clock_.Cancel(std::exchange(talk_timer_, 0));
  if (!talk_ || turn_ || !waiting_.empty()) return;
  if (!talk_->ending.empty()) return EndTalk(talk_->ending);
  if (talk_->turns >= talk_->most) return EndTalk("TURNS");
  if (talk_->silence.count() == 0) return;
  talk_timer_ = clock_.After(talk_->silence, [this] {
    talk_timer_ = 0;
    EndTalk("SILENCE");
  });
}

/// The borrower takes over, and what was arranged with it is forgotten.
ChatModule::Talk ChatModule::TakeBack() {
  Talk talk = std::move(*talk_);
  talk_.reset();
  clock_.Cancel(std::exchange(talk_timer_, 0));
  if (hub_state_ == HubState::kThere && !Listens()) AskForHaste(false);
  for (const char* const slot : {"Talk.goal", "Talk.end"}) slots_.Report(slot, "");
  if (!talk.borrower.empty() && hub_state_ == HubState::kThere)
    hub_.Say(vm::To(kHubName, vm::Set("Subscribe", Subscriptions())));
  return talk;
}

void ChatModule::FailTalk(const vm::Error& error) {
  const Talk talk = TakeBack();
  slots_.Report("Talk.over", "FAILED " + vm::FormatError(error));
  talk.reply.Fail(error);
}

void ChatModule::EndTalk(std::string reason) {
  const Talk talk = TakeBack();
  const std::string end =
      reason + " " + std::to_string(talk.turns) + (talk.last.empty() ? "" : " ") + talk.last;
  slots_.Report("Talk.over", end);
  talk.reply.Ok(end);
}

}  // namespace chat
