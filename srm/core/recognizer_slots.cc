// What the ear can be told and asked. The first slots are those of srm_stub, with their meaning.

#include <utility>

#include "srm/core/recognizer_module.h"

namespace srm {

void RecognizerModule::DeclareListen() {
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
  milliseconds("Listen.silence", endpoints_.silence,
               "After so many ms of silence an utterance is over.", [this](Millis ms) {
                 endpoints_.silence = std::max(ms, Millis{50});
                 if (ear_) ear_->settings().silence = endpoints_.silence;
               });
  milliseconds("Listen.complete", endpoints_.complete,
               "After so many ms of silence an utterance is over if its words are a whole phrase: "
               "one of an active grammar, or, in dictation, one that does not end in a word behind "
               "which more is said (and, the, my). 0: only Listen.silence counts.",
               [this](Millis ms) {
                 endpoints_.complete = ms.count() > 0 ? std::max(ms, Millis{50}) : Millis{0};
                 if (ear_) ear_->settings().complete = endpoints_.complete;
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
  slots_.Declare({.name = "Listen.nbest",
                  .grammar = "<number 1..10>",
                  .initial = "1",
                  .help = "How many candidates a result has at most; more than one takes some ms.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    most_ = static_cast<std::size_t>(value.number(0));
                    if (ear_) ear_->set_most(most_);
                    return std::to_string(most_);
                  }});
}

void RecognizerModule::DeclareLanguages() {
  slots_.DeclareTold("Listen.languages", options_.languages,
                     "The languages understood without a grammar, by their codes; * where it "
                     "is not known or the server finds out.",
                     false);
}

void RecognizerModule::DeclareAgent() {
  slots_.Declare({.name = "Agent",
                  .grammar = "SPEAKING | SILENT",
                  .initial = "SILENT",
                  .help = "Whether the agent itself is speaking; see Agent.echo.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    SetAgentSpeaking(value.word(0) == "SPEAKING");
                    return value.word(0);
                  },
                  .saved = false});
  slots_.Declare(
      {.name = "Agent.echo",
       .grammar = "HALF | OPEN | CANCEL",
       .initial = "HALF",
       .help = "HALF: while the agent speaks, only the phrases of Spot are listened for, "
               "so its own voice is no input. OPEN: everything is heard (there are "
               "headphones); BargeIn says when. CANCEL: the sound of Agent.voice is taken "
               "out of what is heard, then as OPEN.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         const std::string& word = value.word(0);
         SetEcho(word == "HALF" ? Echo::kHalf : word == "OPEN" ? Echo::kOpen : Echo::kCancel);
         return word;
       }});
  slots_.Declare({.name = "Agent.voice",
                  .grammar = "NONE | <text>",
                  .initial = "NONE",
                  .help =
                      "Where the agent's own voice can be had as it is played, for Agent.echo = "
                      "CANCEL: a source as for Input, as raw:PATH beside ssm --sink raw:PATH.",
                  .on_set = [this](const vm::SetValue& value) { return SetVoice(value.text); },
                  .on_inq = [this] { return voice_name_; },
                  .saved = false});
  slots_.Declare({.name = "Spot",
                  .grammar = "NONE | <text>",
                  .initial = "NONE",
                  .help = "Phrases with | between, listened for in all sound, also while the agent "
                          "speaks; Spot.heard reports them. For interruptions: stop | wait.",
                  .on_set = [this](const vm::SetValue& value) { return SetSpot(value.text); },
                  .saved = false});
}

void RecognizerModule::DeclareGrammar() {
  ear::DeclareGrammarSlots(
      slots_,
      {.none_help = "May be changed while somebody speaks: nothing said is lost. With NONE typed "
                    "text is taken as it is, and sound by the language model (dictation).",
       .activate = [this](const vm::SetValue& value) { return ActivateGrammars(value); },
       .load = [this](const std::string& name,
                      const std::string& text) { return LoadGrammar(name, text); },
       .read_file = options_.read_file,
       .drop = [this](const std::string& name) { return DropGrammar(name); },
       .names = [this] { return grammars_.Names(); }});
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
                      "raw[@RATE]:PATH (16 bit mono from a pipe, - is standard input), "
                      "tcp[@RATE]:PORT or unix[@RATE]:PATH (the same from whoever connects), "
                      "portaudio[:DEVICE]. RATE is in Hz, 16000 without. It is "
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
             if (!listening_.on()) {
               return reply.Fail({vm::Errc::kBusy, "not listening; set Run = START first", 0});
             }
             listening_.Hear();
             Recognize(value.text, nullptr, scheduler_.Now());
             reply.Ok(value.text);
             listening_.Wait();
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
  told("Result.confidence", "0 to 1, reported before Result and NoMatch; 1 for typed text.", false);
  told("Result.words",
       "WORD[START-END] ..., ms from the start of the source, reported before Result.", false);
  told("Result.wordconfidence",
       "WORD CONFIDENCE ..., 0 to 1 by each word's own sound, reported before Result.", false);
  told("Result.nbest",
       "CONFIDENCE TEXT | CONFIDENCE TEXT ..., what fits a grammar, best first, at most "
       "Listen.nbest; reported before Result.",
       false);
  ear::DeclareResultSlots(slots_);
  told("BargeIn",
       "Somebody began to speak while the agent speaks; ms from the start of the source.", true);
  told("Spot.heard", "A phrase of Spot was heard.", true);
}

}  // namespace srm
