// What the ear can be told and asked. The first slots are those of srm_stub, with their meaning.

#include <utility>

#include "srm/core/recognizer_module.h"

namespace srm {

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
  const auto told = [this](std::string name, std::string value, std::string help) {
    slots_.Declare({.name = std::move(name),
                    .grammar = "<text>",
                    .access = vm::Access::kReadOnly,
                    .initial = std::move(value),
                    .help = std::move(help),
                    .quoted = true});
  };
  told("ModuleVersion", options_.module_version, "The version of this program.");
  told("ProtocolVersion", "Protocol Ver. 1.0", "The version of the protocol it speaks.");
}

void RecognizerModule::DeclareListen() {
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
  const auto milliseconds = [this](std::string name, Millis initial, std::string help,
                                   std::function<void(Millis)> act) {
    slots_.Declare(
        {.name = std::move(name),
         .grammar = "<ms>",
         .initial = std::to_string(initial.count()),
         .help = std::move(help),
         .on_set = [act = std::move(act)](const vm::SetValue& value) -> vm::Result<std::string> {
           const Millis ms(static_cast<long>(value.number(0)));
           act(ms);
           return std::to_string(ms.count());
         }});
  };
  milliseconds("Listen.timeout", timeout_,
               "If nobody speaks for so many ms after listening began or after the last result, "
               "NoInput is reported once; 0 = never.",
               [this](Millis ms) {
                 timeout_ = ms;
                 if (!ear_ || !ear_->in_speech()) ArmNoInput();
               });
  milliseconds("Listen.silence", endpoints_.silence,
               "After so many ms of silence an utterance is over.", [this](Millis ms) {
                 endpoints_.silence = std::max(ms, Millis{50});
                 if (ear_) ear_->settings().silence = endpoints_.silence;
               });
  slots_.Declare({.name = "Listen.level",
                  .grammar = "<number 3..40>",
                  .initial = "9",
                  .help = "How many dB above the noise speech is.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    endpoints_.above_noise_db = value.number(0);
                    if (ear_) ear_->settings().above_noise_db = value.number(0);
                    return value.text;
                  }});
  slots_.Declare({.name = "Listen.threshold",
                  .grammar = "<number 0..1>",
                  .initial = "0.5",
                  .help = "A result of less confidence than this is NoMatch.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    threshold_ = value.number(0);
                    return value.text;
                  }});
  slots_.Declare({.name = "Agent",
                  .grammar = "SPEAKING | SILENT",
                  .initial = "SILENT",
                  .help = "Whether the agent itself is speaking; see Agent.echo.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    SetAgentSpeaking(value.word(0) == "SPEAKING");
                    return value.word(0);
                  },
                  .saved = false});
  slots_.Declare({.name = "Agent.echo",
                  .grammar = "HALF | OPEN",
                  .initial = "HALF",
                  .help =
                      "HALF: while the agent speaks, only the phrases of Spot are listened for, "
                      "so its own voice is no input. OPEN: everything is heard (the echo is "
                      "cancelled elsewhere, or there are headphones); BargeIn says when.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    half_duplex_ = value.word(0) == "HALF";
                    SetAgentSpeaking(agent_speaking_);
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Spot",
                  .grammar = "NONE | <text>",
                  .initial = "NONE",
                  .help = "Phrases with | between, listened for in all sound, also while the agent "
                          "speaks; Spot.heard reports them. For interruptions: stop | wait.",
                  .on_set = [this](const vm::SetValue& value) { return SetSpot(value.text); },
                  .saved = false});
}

void RecognizerModule::DeclareGrammar() {
  slots_.Declare({.name = "Grammar",
                  .grammar = "NONE | <word>...",
                  .initial = "NONE",
                  .auto_output = true,
                  .help = "The active grammars, by name; a match is sought in this order. May be "
                          "changed while somebody speaks: nothing said is lost. With NONE typed "
                          "text is taken as it is, and sound by the language model (dictation).",
                  .on_set = [this](const vm::SetValue& value) { return ActivateGrammars(value); },
                  .saved = false});
  slots_.Declare(
      {.name = "Grammar.load",
       .grammar = "<word> <text>",
       .access = vm::Access::kWriteOnly,
       .help = "NAME PHRASE | PHRASE ...: loads or replaces a grammar. A phrase has words, * for "
               "any word, [optional words], (one | other), x+, x<2-4>, /WEIGHT/ and {meaning}. "
               "Case and punctuation do not count. docs/speech.md has the whole form.",
       .on_set =
           [this](const vm::SetValue& value) { return LoadGrammar(value.word(0), value.word(1)); },
       .saved = false});
  slots_.Declare({.name = "Grammar.file",
                  .grammar = "<word> <file>",
                  .access = vm::Access::kWriteOnly,
                  .help = "NAME FILE: the same from a file: a phrase on each line and rules "
                          "$name = ..., or JSGF, or SRGS in XML; told by its first characters.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    auto text = options_.read_file(value.word(1));
                    if (!text) return std::unexpected(text.error());
                    auto loaded = LoadGrammar(value.word(0), *text);
                    if (!loaded) {
                      return vm::Fail(loaded.error().code,
                                      value.word(1) + ": " + loaded.error().text);
                    }
                    return loaded;
                  },
                  .saved = false});
  slots_.Declare(
      {.name = "Grammar.drop",
       .grammar = "<word>",
       .access = vm::Access::kWriteOnly,
       .help = "Forgets a grammar; it is no longer active then.",
       .on_set = [this](const vm::SetValue& value) { return DropGrammar(value.word(0)); },
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
  slots_.Declare({.name = "Grammar.word",
                  .grammar = "<word> <text>",
                  .access = vm::Access::kWriteOnly,
                  .help = "WORD SPOKEN: how a word is said, in kana or in phonemes (G AE L AH T). "
                          "Words nobody tells about follow a dictionary and rules.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    auto ear = NeedEar();
                    if (!ear) return std::unexpected(ear.error());
                    if (auto taken = (*ear)->Pronounce(value.word(0), value.word(1)); !taken) {
                      return std::unexpected(taken.error());
                    }
                    pronunciations_.emplace_back(value.word(0), value.word(1));
                    return value.text;
                  },
                  .saved = false});
}

void RecognizerModule::DeclareInput() {
  slots_.Declare({.name = "Input",
                  .grammar = "NONE | <text>",
                  .initial = "NONE",
                  .auto_output = true,
                  .help =
                      "Where sound comes from: NONE, wav:PATH (once, at the pace of the clock), "
                      "raw:PATH (16 kHz 16 bit mono from a pipe), portaudio[:DEVICE]. It is "
                      "heard while listening.",
                  .on_set = [this](const vm::SetValue& value) { return SetInput(value.text); },
                  .on_inq = [this] { return source_name_; },
                  .saved = false});
  slots_.Declare(
      {.name = "Input.text",
       .grammar = "<text>",
       .access = vm::Access::kWriteOnly,
       .help = "What somebody says, typed. Refused while not listening.",
       .on_set_later =
           [this](const vm::SetValue& value, const vm::Reply& reply) {
             if (!listening_) {
               return reply.Fail({vm::Errc::kBusy, "not listening; set Run = START first", 0});
             }
             slots_.Report("Listen.stat", "SPEECH");
             Recognize(value.text, nullptr);
             reply.Ok(value.text);
             slots_.Report("Listen.stat", "LISTENING");
             ArmNoInput();
           },
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
  told("Result.confidence", "0 to 1, reported before Result and NoMatch; 1 for typed text.", false);
  told("Result.words",
       "WORD[START-END] ..., ms from the start of the source, reported before Result.", false);
  told("Result.grammar", "The grammar that matched, reported before Result; empty without one.",
       true);
  told("Result.tag",
       "The {meaning} of what matched, several with ; between, reported before Result.", true);
  told("Result.xml",
       "The same in XML on one line, reported before Result: <result start=MS end=MS><candidate "
       "rank=1 confidence=C grammar=NAME tag=MEANING>TEXT</candidate></result>; no candidate where "
       "nothing matched.",
       false);
  told("Result", "What was said, if it matched.", true);
  told("NoMatch", "What was heard but fits no active grammar, or not well enough.", true);
  told("NoInput", "Nobody spoke for so many ms (Listen.timeout).", true);
  told("BargeIn",
       "Somebody began to speak while the agent speaks; ms from the start of the source.", true);
  told("Spot.heard", "A phrase of Spot was heard.", true);
}

}  // namespace srm
