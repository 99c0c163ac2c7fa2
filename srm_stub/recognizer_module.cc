#include "srm_stub/recognizer_module.h"

#include <algorithm>
#include <utility>

namespace srm_stub {
namespace {

std::string EscapeXml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

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

}  // namespace

RecognizerModule::RecognizerModule(vm::Scheduler& scheduler, Options options)
    : scheduler_(scheduler), options_(std::move(options)), slots_("SRM") {
  DeclareRun();
  DeclareGrammar();
  DeclareInput();
  DeclareResult();
}

RecognizerModule::~RecognizerModule() { Shutdown(); }

bool RecognizerModule::Busy() const {
  return !inputs_.empty() || !script_.empty() || no_input_timer_ != 0;
}

void RecognizerModule::Shutdown() {
  for (vm::TimerId* timer : {&word_timer_, &no_input_timer_, &script_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
  script_.clear();
  for (auto given_up = std::exchange(inputs_, {}); !given_up.empty(); given_up.pop_front()) {
    given_up.front().reply.Fail({vm::Errc::kStopped, "the module ends", 0});
  }
}

// --- what there is to set and to ask

void RecognizerModule::DeclareRun() {
  slots_.Declare({.name = "Run",
                  .grammar = "START | STOP | LIVE | EXIT",
                  .initial = "LIVE",
                  .auto_output = true,
                  .help = "START: listen from now on. STOP: no longer. EXIT ends the module.",
                  .on_set_later =
                      [this](const vm::SetValue& value, const vm::Reply& reply) {
                        const std::string& word = value.word(0);
                        slots_.Report("Run", word);
                        if (word == "START") StartListening();
                        if (word == "STOP") StopListening();
                        reply.Ok(word);
                        if (word == "EXIT") exit_requested_ = true;
                      },
                  .saved = false});
  slots_.Declare({.name = "ModuleVersion",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = options_.module_version,
                  .help = "The version of this program.",
                  .quoted = true});
  slots_.Declare({.name = "ProtocolVersion",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = "Protocol Ver. 1.0",
                  .help = "The version of the protocol it speaks.",
                  .quoted = true});
  slots_.Declare({.name = "Listen",
                  .grammar = "START | STOP",
                  .initial = "STOP",
                  .help = "The same as Run = START and Run = STOP. What is being heard at STOP is "
                          "dropped.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    value.word(0) == "START" ? StartListening() : StopListening();
                    return value.word(0);
                  },
                  .on_inq = [this] { return listening_ ? "START" : "STOP"; },
                  .saved = false});
  slots_.Declare({.name = "Listen.stat",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = "OFF",
                  .auto_output = true,
                  .help = "OFF, LISTENING (nothing heard yet) or SPEECH (somebody is speaking)."});
  slots_.Declare({.name = "Listen.timeout",
                  .grammar = "<ms>",
                  .initial = "0",
                  .help = "If nobody speaks for so many ms after listening began or after the last "
                          "result, NoInput is reported once; 0 = never.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    timeout_ = Millis(static_cast<long>(value.number(0)));
                    if (listening_ && inputs_.empty()) ArmNoInput();
                    return std::to_string(timeout_.count());
                  }});
}

void RecognizerModule::DeclareGrammar() {
  slots_.Declare({.name = "Grammar",
                  .grammar = "NONE | <word>...",
                  .initial = "NONE",
                  .auto_output = true,
                  .help =
                      "The active grammars, by name; a match is sought in this order. With NONE "
                      "everything is taken as it is heard.",
                  .on_set = [this](const vm::SetValue& value) { return ActivateGrammars(value); },
                  .saved = false});
  slots_.Declare(
      {.name = "Grammar.load",
       .grammar = "<word> <text>",
       .access = vm::Access::kWriteOnly,
       .help = "NAME PHRASE | PHRASE ...: loads or replaces a grammar. A phrase has words, "
               "* for any word, [optional words], (one | other), and may end in {meaning}. "
               "Case and punctuation do not count.",
       .on_set =
           [this](const vm::SetValue& value) { return LoadGrammar(value.word(0), value.word(1)); },
       .saved = false});
  slots_.Declare({.name = "Grammar.file",
                  .grammar = "<word> <file>",
                  .access = vm::Access::kWriteOnly,
                  .help = "NAME FILE: the same from a file with a phrase on each line.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    auto text = options_.read_file(value.word(1));
                    if (!text) return std::unexpected(text.error());
                    std::string phrases;
                    for (std::size_t at = 0; at < text->size();) {
                      const std::size_t end = std::min(text->find('\n', at), text->size());
                      std::string line = text->substr(at, end - at);
                      at = end + 1;
                      if (line.ends_with('\r')) line.pop_back();
                      if (line.find_first_not_of(" \t") == std::string::npos || line[0] == '#')
                        continue;
                      phrases += (phrases.empty() ? "" : " | ") + line;
                    }
                    return LoadGrammar(value.word(0), phrases);
                  },
                  .saved = false});
  slots_.Declare(
      {.name = "Grammar.drop",
       .grammar = "<word>",
       .access = vm::Access::kWriteOnly,
       .help = "Forgets a grammar; it is no longer active then.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         if (grammars_.erase(value.word(0)) == 0) {
           return vm::Fail(vm::Errc::kBadValue, "no grammar '" + value.word(0) + "' is loaded");
         }
         if (std::erase(active_, value.word(0)) > 0) {
           slots_.Report("Grammar", active_.empty() ? "NONE" : Join(active_, active_.size()));
         }
         return value.word(0);
       },
       .saved = false});
  slots_.Declare({.name = "Grammar.set",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "The names of the grammars loaded.",
                  .on_inq = [this] {
                    std::string names;
                    for (const auto& [name, grammar] : grammars_)
                      names += (names.empty() ? "" : " ") + name;
                    return names;
                  }});
}

void RecognizerModule::DeclareInput() {
  slots_.Declare({.name = "Input.text",
                  .grammar = "<text>",
                  .access = vm::Access::kWriteOnly,
                  .help =
                      "What somebody says. Refused while not listening. Further texts wait until "
                      "this one has been heard.",
                  .on_set_later = [this](const vm::SetValue& value,
                                         const vm::Reply& reply) { Take(value.text, reply); },
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

void RecognizerModule::DeclareResult() {
  const auto told = [this](std::string name, std::string help, bool auto_output) {
    slots_.Declare({.name = std::move(name),
                    .grammar = "<text>",
                    .access = vm::Access::kReadOnly,
                    .auto_output = auto_output,
                    .help = std::move(help)});
  };
  told("Result.partial", "The words heard so far; may still change.", true);
  told("Result.grammar", "The grammar that matched, reported before Result; empty without one.",
       true);
  told("Result.tag", "The {meaning} of the phrase that matched, reported before Result.", true);
  told("Result.xml",
       "The same in XML on one line, reported before Result: <result start=MS end=MS><candidate "
       "rank=1 confidence=1 grammar=NAME tag=MEANING>TEXT</candidate></result>; no candidate where "
       "nothing matched.",
       false);
  told("Result", "What was said, as written, if it matched.", true);
  told("NoMatch", "What was said but matched no active grammar.", true);
  told("NoInput", "Nobody spoke for so many ms (Listen.timeout).", true);
}

// --- grammars

vm::Result<std::string> RecognizerModule::LoadGrammar(const std::string& name,
                                                      const std::string& text) {
  if (name == "NONE" || !vm::IsSlotName(name)) {
    return vm::Fail(vm::Errc::kBadValue, "'" + name + "' cannot be a grammar's name");
  }
  auto grammar = WordGrammar::Parse(text);
  if (!grammar) return std::unexpected(grammar.error());
  if (!grammars_.contains(name) && grammars_.size() >= kMaxGrammars) {
    return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMaxGrammars) + " grammars");
  }
  grammars_.insert_or_assign(name, std::move(*grammar));
  return name;
}

vm::Result<std::string> RecognizerModule::ActivateGrammars(const vm::SetValue& value) {
  std::vector<std::string> wanted;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string& name = value.word(i);
    if (name == "NONE" && value.size() == 1) break;
    if (!grammars_.contains(name)) {
      return vm::Fail(vm::Errc::kBadValue, "no grammar '" + name + "' is loaded");
    }
    if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) wanted.push_back(name);
  }
  active_ = std::move(wanted);
  return active_.empty() ? "NONE" : Join(active_, active_.size());
}

// --- listening

void RecognizerModule::StartListening() {
  if (listening_) return;
  listening_ = true;
  SetStat("LISTENING");
  ArmNoInput();
}

void RecognizerModule::StopListening() {
  if (!listening_) return;
  listening_ = false;
  for (vm::TimerId* timer : {&word_timer_, &no_input_timer_}) {
    if (*timer != 0) scheduler_.Cancel(std::exchange(*timer, 0));
  }
  for (auto given_up = std::exchange(inputs_, {}); !given_up.empty(); given_up.pop_front()) {
    given_up.front().reply.Fail({vm::Errc::kStopped, "listening was stopped", 0});
  }
  SetStat("OFF");
}

void RecognizerModule::ArmNoInput() {
  if (no_input_timer_ != 0) scheduler_.Cancel(std::exchange(no_input_timer_, 0));
  if (timeout_.count() == 0) return;
  no_input_timer_ = scheduler_.After(timeout_, [this] {
    no_input_timer_ = 0;
    slots_.Report("NoInput", std::to_string(timeout_.count()));
  });
}

void RecognizerModule::Take(const std::string& text, const vm::Reply& reply) {
  if (!listening_) return reply.Fail(kNotListening);
  if (inputs_.size() >= kMaxQueuedInputs) {
    return reply.Fail(
        {vm::Errc::kLimit, "more than " + std::to_string(kMaxQueuedInputs) + " texts wait", 0});
  }
  inputs_.push_back({text, reply});
  if (inputs_.size() == 1) Hear(inputs_.front());
}

void RecognizerModule::Hear(const Input& input) {
  if (no_input_timer_ != 0) scheduler_.Cancel(std::exchange(no_input_timer_, 0));
  written_ = Pieces(input.text);
  heard_since_ = scheduler_.Now();
  SetStat("SPEECH");
  if (word_time_.count() == 0 || written_.empty()) return Finish();
  word_timer_ = scheduler_.After(word_time_, [this] { HearWord(1); });
}

void RecognizerModule::HearWord(std::size_t count) {
  word_timer_ = 0;
  slots_.Report("Result.partial", Join(written_, count));
  if (count == written_.size()) return Finish();
  word_timer_ = scheduler_.After(word_time_, [this, count] { HearWord(count + 1); });
}

void RecognizerModule::Finish() {
  const vm::Reply reply = inputs_.front().reply;
  const std::string text = Join(written_, written_.size());
  Recognize(text);
  reply.Ok(text);
  inputs_.pop_front();
  SetStat("LISTENING");
  if (inputs_.empty()) return ArmNoInput();
  // The next one begins after what is due now; a chain of calls would grow with the queue.
  word_timer_ = scheduler_.Post([this] {
    word_timer_ = 0;
    Hear(inputs_.front());
  });
}

void RecognizerModule::Recognize(const std::string& text) {
  const std::vector<std::string> words = WordsOf(text);
  bool matched = active_.empty() && !words.empty();
  std::string grammar, tag;
  for (const std::string& name : active_) {
    if (words.empty()) break;
    if (auto meaning = grammars_.at(name).Match(words)) {
      matched = true;
      grammar = name;
      tag = std::move(*meaning);
      break;
    }
  }
  std::string xml = "<result start=\"" + vm::FormatMs(heard_since_) + "\" end=\"" +
                    vm::FormatMs(scheduler_.Now()) + "\">";
  if (matched) {
    xml += "<candidate rank=\"1\" confidence=\"1\" grammar=\"" + EscapeXml(grammar) + "\" tag=\"" +
           EscapeXml(tag) + "\">" + EscapeXml(text) + "</candidate>";
  }
  xml += "</result>";
  if (matched) {
    slots_.Report("Result.grammar", grammar);
    slots_.Report("Result.tag", tag);
  }
  slots_.Report("Result.xml", xml);
  slots_.Report(matched ? "Result" : "NoMatch", text);
}

void RecognizerModule::SetStat(const std::string& stat) { slots_.Report("Listen.stat", stat); }

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
    Take(line.text, vm::Reply([this, number = line.number](vm::Result<std::string> taken) {
           if (taken) return;
           slots_.ReportError("Input.script",
                              {taken.error().code,
                               "line " + std::to_string(number) + ": " + taken.error().text, 0});
         }));
    NextScriptLine();
  });
}

}  // namespace srm_stub
