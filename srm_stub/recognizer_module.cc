#include "srm_stub/recognizer_module.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "ear/result_report.h"

namespace srm_stub {
namespace {

/// The pieces between blanks, as written.
std::vector<std::string> Pieces(std::string_view text) {
  std::vector<std::string> pieces;
  while (true) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return pieces;
    const std::size_t end = std::min(text.find_first_of(" \t", begin), text.size());
    pieces.emplace_back(text.substr(begin, end - begin));
    text.remove_prefix(end);
  }
}

std::string Join(const std::vector<std::string>& words, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += (i == 0 ? "" : " ") + words[i];
  return text;
}

const vm::Error kNotListening{vm::Errc::kBusy, "not listening; set Run = START first", 0};

/// How long the sound of a word is where words take no time to hear.
constexpr Millis kWordSound{250};
constexpr double kToneHz = 440;
constexpr double kToneLevel = 3000;

}  // namespace

RecognizerModule::RecognizerModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler),
      options_(std::move(options)),
      slots_("SRM"),
      listening_(scheduler, slots_,
                 {.stopped =
                      [this] {
                        if (word_timer_ != 0) scheduler_.Cancel(std::exchange(word_timer_, 0));
                        DropInputs({vm::Errc::kStopped, "listening was stopped", 0});
                      },
                  .exit = [this] { exit_requested_ = true; },
                  .hearing = [this] { return !inputs_.empty(); },
                  .end =
                      [this] {
                        if (!underway_) return;  // the next one of many has not begun
                        if (word_timer_ != 0) scheduler_.Cancel(std::exchange(word_timer_, 0));
                        Finish();
                      }}),
      keep_(slots_) {
  listening_.Declare(options_.module_version);
  DeclareGrammar();
  DeclareInput();
  ear::DeclareResultSlots(slots_);
  keep_.Declare();
}

RecognizerModule::~RecognizerModule() { Shutdown(); }

bool RecognizerModule::Busy() const {
  return !inputs_.empty() || !script_.empty() || listening_.armed();
}

void RecognizerModule::Shutdown() {
  for (vm::TimerId* timer : {&word_timer_, &script_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
  listening_.Disarm();
  script_.clear();
  DropInputs({vm::Errc::kStopped, "the module ends", 0});
}

void RecognizerModule::DropInputs(const vm::Error& why) {
  for (auto given_up = std::exchange(inputs_, {}); !given_up.empty(); given_up.pop_front()) {
    given_up.front().reply.Fail(why);
  }
}

// --- what there is to set and to ask

void RecognizerModule::DeclareGrammar() {
  ear::DeclareGrammarSlots(
      slots_, {.none_help = "With NONE everything is taken as it is heard.",
               .activate = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                 auto chosen = grammars_.Chosen(value);
                 if (!chosen) return std::unexpected(chosen.error());
                 grammars_.Activate(std::move(*chosen));
                 return grammars_.ActiveNames();
               },
               .load =
                   [this](const std::string& name, const std::string& text) {
                     return grammars_.Put(name, ear::ParseGrammar(text));
                   },
               .read_file = options_.read_file,
               .drop = [this](const std::string& name) -> vm::Result<std::string> {
                 const auto was_active = grammars_.Drop(name);
                 if (!was_active) return std::unexpected(was_active.error());
                 if (*was_active) slots_.Report("Grammar", grammars_.ActiveNames());
                 return name;
               },
               .names = [this] { return grammars_.Names(); }});
}

void RecognizerModule::DeclareInput() {
  slots_.Declare({.name = "Input.text",
                  .grammar = "<text>",
                  .access = vm::Access::kWriteOnly,
                  .help =
                      "What somebody says. Refused while not listening. Further texts wait until "
                      "this one has been heard.",
                  .on_set_later =
                      [this](const vm::SetValue& value, const vm::Reply& reply) {
                        Take({value.text, reply});
                      },
                  .saved = false});
  slots_.Declare({.name = "Input.sound",
                  .grammar = "<int 1..600000>",
                  .access = vm::Access::kWriteOnly,
                  .help =
                      "Somebody is heard for so many ms, without words; else as Input.text. For "
                      "recordings.",
                  .on_set_later =
                      [this](const vm::SetValue& value, const vm::Reply& reply) {
                        Take({"", reply, Millis(static_cast<long>(value.number(0)))});
                      },
                  .saved = false});
  slots_.Declare({.name = "Input.wordtime",
                  .grammar = "<ms>",
                  .initial = "0",
                  .help =
                      "How long each word takes to say; after each Result.partial is reported. 0: "
                      "all is heard at once.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    word_time_ = Millis(static_cast<long>(value.number(0)));
                    return std::to_string(word_time_.count());
                  }});
  slots_.Declare(
      {.name = "Input.script",
       .grammar = "STOP | <file>",
       .initial = "STOP",
       .help = "A file of lines MS TEXT: each text is said so many ms from now. STOP drops "
               "the rest. Lines due while not listening are not heard.",
       .on_set = [this](const vm::SetValue& value) { return StartScript(value.word(0)); },
       .saved = false});
}

// --- hearing

void RecognizerModule::Take(Input input) {
  if (!listening_.on()) return input.reply.Fail(kNotListening);
  if (inputs_.size() >= kMaxQueuedInputs) {
    return input.reply.Fail(
        {vm::Errc::kLimit, "more than " + std::to_string(kMaxQueuedInputs) + " texts wait", 0});
  }
  inputs_.push_back(std::move(input));
  if (inputs_.size() == 1) Hear(inputs_.front());
}

void RecognizerModule::Hear(const Input& input) {
  written_ = Pieces(input.text);
  heard_since_ = scheduler_.Now();
  said_ = 0;
  underway_ = true;
  listening_.Hear();
  if (input.sound.count() > 0) return Until(heard_since_ + input.sound, 0);
  if (word_time_.count() > 0 && !written_.empty()) return Until(heard_since_ + word_time_, 1);
  said_ = written_.size();
  Finish();
}

/// At that time so many words are said; Listen.longest may come before.
void RecognizerModule::Until(vm::Time when, std::size_t words) {
  const vm::Time last = heard_since_ + listening_.longest();
  if (when > last) {
    word_timer_ = scheduler_.At(last, [this] {
      word_timer_ = 0;
      Finish();
    });
  } else {
    word_timer_ = scheduler_.At(when, [this, words] { HearWord(words); });
  }
}

void RecognizerModule::HearWord(std::size_t count) {
  word_timer_ = 0;
  said_ = count;
  if (count > 0) slots_.Report("Result.partial", Join(written_, count));
  if (count == written_.size()) return Finish();
  Until(scheduler_.Now() + word_time_, count + 1);
}

void RecognizerModule::Finish() {
  underway_ = false;
  const vm::Reply reply = inputs_.front().reply;
  const std::string text = Join(written_, said_);
  KeepSound();
  Recognize(text);
  reply.Ok(text);
  inputs_.pop_front();
  listening_.Wait(!inputs_.empty());
  if (inputs_.empty()) return;
  // The next one begins after what is due now; a chain of calls would grow with the queue.
  word_timer_ = scheduler_.Post([this] {
    word_timer_ = 0;
    Hear(inputs_.front());
  });
}

/// As long as it took to hear; where words take no time, kWordSound for each.
void RecognizerModule::KeepSound() {
  if (!keep_.on()) return;
  const auto heard = std::chrono::duration_cast<Millis>(scheduler_.Now() - heard_since_);
  const bool timed = word_time_.count() > 0 || inputs_.front().sound.count() > 0;
  const Millis words = kWordSound * static_cast<long>(said_);
  const Millis length = std::min(timed ? heard : words, listening_.longest());
  std::vector<std::int16_t> tone(static_cast<std::size_t>(length.count()) *
                                 ear::SoundKeep::kRateHz / 1000);
  const double step = 2 * std::numbers::pi * kToneHz / ear::SoundKeep::kRateHz;
  for (std::size_t i = 0; i < tone.size(); ++i) {
    tone[i] = static_cast<std::int16_t>(kToneLevel * std::sin(step * static_cast<double>(i)));
  }
  keep_.Keep(tone, length == listening_.longest());
}

void RecognizerModule::Recognize(const std::string& text) {
  const std::vector<std::string> words = ear::WordsOf(text);
  ear::ResultReport report{.start = heard_since_, .end = scheduler_.Now()};
  if (grammars_.active().empty() && !words.empty()) report.candidates.push_back({.text = text});
  for (const std::string& name : grammars_.active()) {
    if (words.empty() || !report.candidates.empty()) break;
    if (auto meaning = grammars_.at(name).Match(words)) {
      report.candidates.push_back({.text = text, .grammar = name, .tag = meaning->Joined()});
    }
  }
  ear::TellResult(slots_, report, text);
}

// --- scripts

vm::Result<std::string> RecognizerModule::StartScript(const std::string& path) {
  std::vector<ScriptLine> lines;
  if (path != "STOP") {
    auto text = options_.read_file(path);
    if (!text) return std::unexpected(text.error());
    auto parsed = ParseScript(*text);
    if (!parsed) return std::unexpected(parsed.error());
    lines = std::move(*parsed);
  }
  if (script_timer_ != 0) scheduler_.Cancel(std::exchange(script_timer_, 0));
  script_.assign(lines.begin(), lines.end());
  script_start_ = scheduler_.Now();
  NextScriptLine();
  return script_.empty() ? "STOP" : path;
}

void RecognizerModule::NextScriptLine() {
  if (script_.empty()) return slots_.Store("Input.script", "STOP");
  script_timer_ = scheduler_.At(script_start_ + script_.front().at, [this] {
    script_timer_ = 0;
    const ScriptLine line = std::move(script_.front());
    script_.pop_front();
    Take({line.text, vm::Reply([this, number = line.number](vm::Result<std::string> taken) {
            if (taken) return;
            slots_.ReportError("Input.script",
                               {taken.error().code,
                                "line " + std::to_string(number) + ": " + taken.error().text, 0});
          })});
    NextScriptLine();
  });
}

}  // namespace srm_stub
