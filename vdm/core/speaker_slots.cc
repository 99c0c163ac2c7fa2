// Whose voice is heard: known speakers, and meeting a new one.

#include <utility>

#include "vdm/core/movement_module.h"

namespace vdm {

void MovementModule::DeclareSpeaker() {
  slots_.Declare(
      {.name = "Speaker",
       .grammar = "NONE | <word>",
       .initial = "NONE",
       .auto_output = true,
       .help =
           "Whose voice is heard: a name that was learned, in this run or from the folder given "
           "by --speakers, or NONE for anybody's.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         const std::string& name = value.word(0);
         auto speaker = name == "NONE" ? vm::Result<Speaker>(Speaker{}) : speakers_.Find(name);
         if (!speaker) return std::unexpected(speaker.error());
         speaker_ = *speaker;
         Renew();
         return name;
       }});
  slots_.Declare(
      {.name = "Speaker.learn",
       .grammar = "NONE | <word>",
       .initial = "NONE",
       .auto_output = true,
       .help = "Meets a speaker of that name, who now says the vowels a, i, u, e, o one after the "
               "other, with pauses, within 20 s of the sound that is heard: the vocal tract is "
               "chosen with which they are recognised best. It is NONE again when it is done, and "
               "Speaker is the name; where it fails there is an error. NONE ends it. Modes PHONES "
               "and MEL.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         const std::string& name = value.word(0);
         learner_.reset();
         if (name == "NONE") return name;
         if (!SpeakerStore::IsName(name)) {
           return vm::Fail(vm::Errc::kBadValue,
                           "'" + name + "' found, 1 to 40 letters, digits, - and _ expected");
         }
         if (mode_ != Mode::kPhones && mode_ != Mode::kMel) {
           return vm::Fail(vm::Errc::kUnavailable,
                           "speakers can be met in the modes PHONES and MEL only");
         }
         learned_name_ = name;
         learner_ = std::make_unique<SpeakerLearner>(net(), BuiltVowels());
         return name;
       },
       .saved = false});
}

void MovementModule::Learned(const vm::Result<Speaker>& met) {
  learner_.reset();
  auto kept = met ? speakers_.Keep(learned_name_, *met) : std::unexpected(met.error());
  slots_.Report("Speaker.learn", "NONE");
  if (!kept) return slots_.ReportError("Speaker.learn", kept.error());
  speaker_ = *met;
  Renew();
  slots_.Report("Speaker", learned_name_);
}

}  // namespace vdm
