#include "ear/listening.h"

#include <utility>

namespace ear {

Listening::Listening(vm::Scheduler& scheduler, vm::SlotMachine& slots, Hooks hooks)
    : scheduler_(scheduler), slots_(slots), hooks_(std::move(hooks)) {}

void Listening::Declare(const std::string& module_version) {
  slots_.Declare(
      {.name = "Run",
       .grammar = "START | STOP | LIVE | SLEEP | EXIT",
       .initial = "LIVE",
       .auto_output = true,
       .help = "START: listen from now on. STOP: no longer. EXIT ends the module. SLEEP, which "
               "scripts of the original have, does nothing.",
       .on_set_later =
           [this](const vm::SetValue& value, const vm::Reply& reply) {
             const std::string& word = value.word(0);
             if (word != "SLEEP") slots_.Report("Run", word);
             if (word == "START") Start();
             if (word == "STOP") Stop();
             reply.Ok(word);
             if (word == "EXIT") hooks_.exit();
           },
       .saved = false});
  const auto version = [this](std::string name, std::string value, std::string help) {
    slots_.Declare({.name = std::move(name),
                    .grammar = "<text>",
                    .access = vm::Access::kReadOnly,
                    .initial = std::move(value),
                    .help = std::move(help),
                    .quoted = true});
  };
  version("ModuleVersion", module_version, "The version of this program.");
  version("ProtocolVersion", "Protocol Ver. 1.0", "The version of the protocol it speaks.");
  slots_.Declare({.name = "Listen",
                  .grammar = "START | STOP",
                  .initial = "STOP",
                  .help = "The same as Run = START and Run = STOP. What is being heard at STOP is "
                          "dropped.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    value.word(0) == "START" ? Start() : Stop();
                    return value.word(0);
                  },
                  .on_inq = [this] { return on_ ? "START" : "STOP"; },
                  .saved = false});
  slots_.DeclareTold("Listen.stat", "OFF",
                     "OFF, LISTENING (nothing heard yet) or SPEECH (somebody is speaking).", true);
  slots_.Declare({.name = "Listen.timeout",
                  .grammar = "<ms>",
                  .initial = "0",
                  .help = "If nobody speaks for so many ms after listening began or after the last "
                          "result, NoInput is reported once; 0 = never.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    timeout_ = Millis(static_cast<long>(value.number(0)));
                    if (on_ && !hooks_.hearing()) Arm();
                    return std::to_string(timeout_.count());
                  }});
  slots_.Declare({.name = "Listen.longest",
                  .grammar = "<int 100..600000>",
                  .initial = std::to_string(longest_.count()),
                  .help = "An utterance is ended after so many ms.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    longest_ = Millis(static_cast<long>(value.number(0)));
                    return std::to_string(longest_.count());
                  }});
  slots_.Declare({.name = "Listen.end",
                  .grammar = "NOW",
                  .access = vm::Access::kWriteOnly,
                  .help = "What is being said ends here and is reported as ever; answered then.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (on_ && hooks_.hearing()) hooks_.end();
                    return value.word(0);
                  },
                  .saved = false});
}

void Listening::Start() {
  if (std::exchange(on_, true)) return;
  if (hooks_.started) hooks_.started();
  slots_.Report("Listen.stat", "LISTENING");
  Arm();
}

void Listening::Stop() {
  if (!std::exchange(on_, false)) return;
  Disarm();
  if (hooks_.stopped) hooks_.stopped();
  slots_.Report("Listen.stat", "OFF");
}

void Listening::Hear() {
  Disarm();
  slots_.Report("Listen.stat", "SPEECH");
}

void Listening::Wait(bool more) {
  slots_.Report("Listen.stat", "LISTENING");
  if (!more) Arm();
}

void Listening::Disarm() {
  if (timer_ != 0) scheduler_.Cancel(std::exchange(timer_, 0));
}

void Listening::Arm() {
  Disarm();
  if (timeout_.count() == 0 || !on_) return;
  timer_ = scheduler_.After(timeout_, [this] {
    timer_ = 0;
    slots_.Report("NoInput", std::to_string(timeout_.count()));
  });
}

}  // namespace ear
