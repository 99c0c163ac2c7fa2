// What the module can be told and asked. The order of declaration is that of
// docs/reference/slots.md.

#include "chat/core/chat_module.h"

namespace chat {
namespace {

vm::Result<std::string> Word(const vm::SetValue& value) { return value.word(0); }

}  // namespace

void ChatModule::Told(std::string name, std::string help, std::string initial) {
  slots_.Declare({.name = std::move(name),
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .initial = std::move(initial),
                  .auto_output = true,
                  .help = std::move(help)});
}

void ChatModule::DeclareInput() {
  slots_.Declare({.name = "Input.text",
                  .grammar = "<text>",
                  .access = vm::Access::kWriteOnly,
                  .help = "What somebody says to the agent, as if the ear had heard it; stops what "
                          "is being said. Answered with what the listener has heard of the reply, "
                          "when it is over.",
                  .on_set_later =
                      [this](const vm::SetValue& value, const vm::Reply& reply) {
                        Take({value.text, false, reply});
                      },
                  .saved = false});
  slots_.Declare({.name = "Say",
                  .grammar = "STOP | <text>",
                  .access = vm::Access::kWriteOnly,
                  .help = "The agent says this of its own accord, with tags as in a reply, and "
                          "remembers it. STOP: it is silent at once, and thinks no further.",
                  .on_set_later =
                      [this](const vm::SetValue& value, const vm::Reply& reply) {
                        if (value.size() != 1 || value.word(0) != "STOP")
                          return Take({value.text, true, reply});
                        Interrupt();
                        reply.Ok("STOP");
                      },
                  .saved = false});
  slots_.Declare({.name = "Listen",
                  .grammar = "ON | OFF",
                  .initial = options_.listens ? "ON" : "OFF",
                  .auto_output = true,
                  .help = "Whether what the ear hears is answered. OFF: only Input.text is.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    slots_.Store("Listen", value.word(0));
                    if (value.word(0) == "ON") StartEar();
                    if (hub_state_ == HubState::kThere && !Listens()) AskForHaste(false);
                    return value.word(0);
                  }});
  slots_.Declare(
      {.name = "Listen.pause",
       .grammar = "<int 0..5000>",
       .initial = "250",
       .help = "After so many ms of silence a whole phrase is answered (the ear's Listen.complete "
               "while it listens for a conversation); what seems unfinished has the ear's "
               "Listen.silence. 0: everything has.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         const std::string ms = std::to_string(static_cast<long>(value.number(0)));
         slots_.Store("Listen.pause", ms);
         if (hub_state_ == HubState::kThere && Listens()) AskForHaste(true);
         return ms;
       }});
  slots_.Declare({.name = "BargeIn",
                  .grammar = "ON | OFF",
                  .initial = "ON",
                  .help = "Whether the agent stops when somebody speaks. OFF: what the ear hears "
                          "during a reply is left out (a microphone that hears the loudspeaker).",
                  .on_set = Word});
  slots_.Declare({.name = "Language",
                  .grammar = "AUTO | <word>",
                  .initial = "AUTO",
                  .help = "Of rules and apologies: en, ja, or by the signs of what was said.",
                  .on_set = Word});
  std::string languages;
  for (const Rules& rules : options_.rules)
    languages += (languages.empty() ? "" : " ") + rules.language();
  slots_.DeclareTold("Language.all", UsesModel() ? "*" : languages,
                     "The languages of its answers, by their codes: those of the rules, or * "
                     "where a model answers.");
  slots_.Declare({.name = "Apology",
                  .grammar = "ON | OFF",
                  .initial = "ON",
                  .help = "Whether the agent says so when the model does not answer.",
                  .on_set = Word});
}

void ChatModule::DeclareModel() {
  const auto number = [this](std::string name, std::string grammar, std::string initial,
                             std::string help) {
    slots_.Declare({.name = std::move(name),
                    .grammar = std::move(grammar),
                    .initial = std::move(initial),
                    .help = std::move(help),
                    .on_set = [](const vm::SetValue& value) -> vm::Result<std::string> {
                      return std::to_string(static_cast<long>(value.number(0)));
                    }});
  };
  slots_.Declare({.name = "Model",
                  .grammar = "<text>",
                  .initial = options_.model,
                  .help = "The model's name, as the endpoint knows it."});
  slots_.DeclareTold("Model.url", options_.endpoint.url,
                     "Where it is asked; set when the program is started. Empty: rules answer, "
                     "and nothing is sent anywhere.",
                     false);
  number("Model.tokens", "<int 1..32768>", "400", "The longest reply, in the model's tokens.");
  number("Model.seconds", "<int 1..600>", "60", "How long a reply may take.");
  number("Model.stall", "<int 1..600>", "15", "Seconds without anything new that end a reply.");
  number("Model.bytes", "<int 64..65536>", "16384", "The longest reply, in bytes.");
  slots_.Declare(
      {.name = "Persona",
       .grammar = "<text>",
       .initial = options_.persona,
       .help = "Who the agent is and how it talks; told to the model after the prompt."});
  std::string allowed;
  for (const std::string& place : options_.endpoint.allow_set)
    allowed += (allowed.empty() ? "" : ", ") + place;
  slots_.DeclareTold("Tools", allowed,
                     "The slots the model may set; given when the program is started.", false);
  number("Tools.rounds", "<int 0..20>", "4",
         "How often in one reply the model may set slots before it has to answer.");
}

void ChatModule::DeclareHistory() {
  slots_.Declare({.name = "History",
                  .grammar = "CLEAR",
                  .help =
                      "What both have said, in JSON: a list of role (user, assistant) and "
                      "content. Of a reply only what was heard; what the model did not answer is "
                      "left out. CLEAR: nothing was said.",
                  .on_set = [this](const vm::SetValue&) -> vm::Result<std::string> {
                    history_.Clear();
                    for (Rules& rules : options_.rules) rules.Forget();
                    return "[]";
                  },
                  .on_inq = [this] { return history_.Json(); },
                  .saved = false});
  slots_.Declare({.name = "History.turns",
                  .grammar = "<int 1..200>",
                  .initial = "20",
                  .help = "How many of the user's turns are remembered; at most 16 KiB in all.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    history_.set_turns(static_cast<std::size_t>(value.number(0)));
                    return std::to_string(static_cast<long>(value.number(0)));
                  }});
}

void ChatModule::DeclareReports() {
  Told("Busy", "IDLE, THINKING or SPEAKING.", "IDLE");
  Told("Heard", "What the user said last.");
  Told("Reply.sentence", "The sentence that is spoken from now on.");
  Told("Reply", "The last reply, as far as the listener has heard it.");
  Told("Reply.times",
       "words=MS sentence=MS sound=MS: from the end of the user's words to the first words of the "
       "reply, to its first sentence, and to the first sound.");
}

void ChatModule::DeclareTalk() {
  slots_.Declare(
      {.name = "Talk",
       .grammar = "STOP | END [ <word> ] | <int 1..1000> [ <ms> [ <word> ] ]",
       .access = vm::Access::kWriteOnly,
       .help =
           "A conversation lent to somebody: so many turns, or until nobody has spoken for so many "
           "ms (0: no limit), STOP is said, the user says a phrase of Talk.end, or a reply has the "
           "tag [end], with which the model may give a result. Answered at its end with its "
           "reason, TURNS, SILENCE, ENDED or STOPPED, the number of turns, and what the user said "
           "last; as an error if the model does not answer. Meanwhile the ear is listened to, "
           "whatever Listen says. The word is the borrower's name at the hub: then the answer "
           "is LENT, at once, the end is told by Talk.over, and when the borrower leaves the hub "
           "it "
           "is STOPPED.",
       .on_set_later = [this](const vm::SetValue& value,
                              const vm::Reply& reply) { StartTalk(value, reply); },
       .saved = false});
  slots_.Declare({.name = "Talk.goal",
                  .grammar = "<text>",
                  .help = "What the next conversation lent is for; told to the model behind the "
                          "persona, and forgotten at its end. Rules do not read it.",
                  .saved = false});
  slots_.Declare({.name = "Talk.end",
                  .grammar = "<text>",
                  .help = "Phrases by which the user ends the next conversation lent, with | "
                          "between; forgotten at its end.",
                  .saved = false});
  slots_.DeclareTold("Talk.result", "",
                     "The word that the tag [end WORD] of the last conversation lent had.");
  Told("Talk.over",
       "How the last conversation lent ended: reason, turns and last words as Talk is answered "
       "with, or FAILED and the error.");
}

}  // namespace chat
