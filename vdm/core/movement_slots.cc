// What the module can be told and asked.

#include <fmt/format.h>

#include "vdm/core/movement_module.h"

namespace vdm {

void MovementModule::DeclareRun() {
  vm::DeclareCommonSlots(slots_, {.module_version = options_.module_version,
                                  .protocol_version = "Protocol Ver. 1.0",
                                  .auto_output = true,
                                  .on_start = [this]() -> vm::Result<void> {
                                    Start();
                                    return {};
                                  },
                                  .on_stop = [this] { Stop(); },
                                  .work = "sound is heard and moves the face",
                                  .on_exit = [this] { exit_requested_ = true; }});
}

void MovementModule::DeclareInput() {
  slots_.Declare(
      {.name = "Input",
       .grammar = "NONE | <text>",
       .initial = "NONE",
       .auto_output = true,
       .help = "Where sound comes from: NONE, wav:PATH (once, at the pace of the clock), "
               "raw[@RATE]:PATH (16 bit mono from a pipe, - is standard input; ssm --sink raw:PATH "
               "gives what the voice says), tcp[@RATE]:PORT or unix[@RATE]:PATH (the same from "
               "whoever connects), portaudio[:DEVICE]. RATE is in Hz, 16000 without. It is heard "
               "while Run is START.",
       .on_set = [this](const vm::SetValue& value) { return SetInput(value.text); },
       .on_inq = [this] { return source_name_; },
       .saved = false});
  slots_.Declare(
      {.name = "Delay",
       .grammar = "<number 0..60000>",
       .initial = "100",
       .help = "How many ms after a sound was heard the mouth shows it. The network has to hear "
               "up to 60 ms more first, and sound comes in pieces: less than 100 is refused in "
               "modes PHONES and MEL. Whoever plays the sound plays it so much later, and 40 ms "
               "more for lips "
               "that lead a little, as those of a text do.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         const vm::Time wanted(static_cast<vm::Time::rep>(value.number(0) * 1000));
         if (wanted < ShortestDelay()) {
           return vm::Fail(vm::Errc::kBadValue,
                           fmt::format("{} ms found, at least {} expected: so much more has to be "
                                       "heard before the mouth is known",
                                       value.word(0), vm::FormatMs(ShortestDelay())));
         }
         delay_ = wanted;
         return vm::FormatMs(delay_);
       }});
}

vm::Result<void> MovementModule::SetMode(const std::string& word) {
  const bool words = word == "WORDS";
  if ((words && (options_.words == nullptr || options_.phones == nullptr)) ||
      (word == "PHONES" && options_.phones == nullptr)) {
    const auto can = CanMakeFeatures(words ? FeatureKind::kWords : FeatureKind::kPhones);
    return vm::Fail(vm::Errc::kUnavailable,
                    can ? "this program has no network for " + word : can.error().text);
  }
  best_ = word == "BEST";
  mode_ = best_              ? BestMode()
          : words            ? Mode::kWords
          : word == "PHONES" ? Mode::kPhones
          : word == "MEL"    ? Mode::kMel
          : word == "OFF"    ? Mode::kOff
                             : Mode::kCepstra;
  if (learner_) {
    Learned(
        vm::Fail(vm::Errc::kUnavailable, "another mode was chosen before the vowels were said"));
  }
  Renew();
  delay_ = std::max(delay_, ShortestDelay());
  slots_.Store("Delay", vm::FormatMs(delay_));
  return {};
}

void MovementModule::DeclareMouth() {
  slots_.Declare(
      {.name = "Mouth.mode",
       .grammar = "BEST | WORDS | PHONES | MEL | CEPSTRA | OFF",
       .initial = "BEST",
       .help =
           "By what the mouth is found: PHONES, a network that sees mel bands over time and how "
           "likely the phones of English are by Debian's pocketsphinx-en-us; WORDS, that one and "
           "another, which sees what phones the likeliest words of English would have; MEL, one "
           "that sees mel bands alone; BEST, WORDS where that model is installed and MEL else, "
           "and of a recording on the virtual clock also its English words, which are recognised "
           "before it begins; CEPSTRA, "
           "the small one of the original's papers, which sees 20 LPC cepstra of one frame "
           "(Delay at least 56); OFF: the mouth rests.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         if (auto set = SetMode(value.word(0)); !set) return std::unexpected(set.error());
         return value.word(0);
       }});
  slots_.Declare({.name = "Mouth.net",
                  .grammar = "WORDS | PHONES | MEL | CEPSTRA | OFF",
                  .access = vm::Access::kReadOnly,
                  .help = "What Mouth.mode comes to here.",
                  .on_inq = [this]() -> std::string {
                    return mode_ == Mode::kWords    ? "WORDS"
                           : mode_ == Mode::kPhones ? "PHONES"
                           : mode_ == Mode::kMel    ? "MEL"
                           : mode_ == Mode::kOff    ? "OFF"
                                                    : "CEPSTRA";
                  }});
  slots_.Declare({.name = "Mouth.to",
                  .grammar = "NONE | <word>",
                  .initial = "FSM",
                  .help = "The module that is told the frames, by its slots MouthFrame.start and "
                          "MouthFrame.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    if (!vm::IsModuleName(value.word(0))) {
                      return vm::Fail(vm::Errc::kBadValue,
                                      "'" + value.word(0) + "' is not a module's name");
                    }
                    sender_.Finish();
                    face_ = value.word(0);
                    return face_;
                  }});
  slots_.DeclareTold(
      "Mouth", "",
      "Each frame told: MS on this module's clock, 17 mouth parameters, seal, tongue, as in the "
      "face's MouthFrame.");
  slots_.DeclareTold(
      "Mouth.sounds", "",
      "Each frame's sounds: MS, then NAME LIKELIHOOD of each class of sounds (vdm/tables/"
      "sounds.txt) from 0.05 on.");
  slots_.DeclareTold("Mouth.words", "",
                     "What was recognised in a recording; empty: no words that could be trusted.");
  slots_.DeclareTold("Mouth.stat", "OFF", "OFF, LISTENING (the mouth rests) or MOVING.", true);
}

}  // namespace vdm
