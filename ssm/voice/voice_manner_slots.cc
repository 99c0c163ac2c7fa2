// Who speaks and how: Speaker, Rate, Pitch, Volume, Emotion.

#include <algorithm>
#include <charconv>
#include <utility>

#include "ssm/voice/voice_module.h"

namespace ssm {
namespace {

/// A factor as written back: 1, 1.5, 0.85.
std::string FormatFactor(double factor) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, factor).ptr;
  return {buffer, end};
}

/// "en slt rms; de espeak-de", in the order of the voices.
std::string SpeakersByLanguage(const std::vector<VoiceInfo>& voices) {
  std::vector<std::pair<std::string, std::string>> lists;
  for (const VoiceInfo& voice : voices) {
    auto list = std::ranges::find(lists, voice.language, [](const auto& one) { return one.first; });
    if (list == lists.end()) list = lists.insert(list, {voice.language, voice.language});
    list->second += " " + voice.name;
  }
  std::string text;
  for (const auto& [language, list] : lists) text += (text.empty() ? "" : "; ") + list;
  return text;
}

}  // namespace

void VoiceModule::DeclareManner() {
  slots_.DeclareTold("SpeakerSet", speakers_.Names(),
                     "The names Speaker takes: the engine's voices, then the names of the "
                     "original, which stand for voices of the same sex.");
  slots_.Declare({.name = "Speaker",
                  .grammar = "<word>",
                  .initial = options_.speaker.empty() ? voice_.name : options_.speaker,
                  .auto_output = true,
                  .help = "Who speaks from the next Text on; one of SpeakerSet.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    const auto wanted = speakers_.Wanted(value.word(0));
                    if (!wanted) return std::unexpected(wanted.error());
                    voice_ = **wanted;
                    if (!voice_.pitch_adjustable && pitch_ != 1) {
                      pitch_ = 1;
                      slots_.Report("Pitch", "1");
                    }
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Speaker.all",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "Every name Speaker takes, with the voices of other languages, which "
                          "SpeakerSet leaves out.",
                  .on_inq = [this] { return speakers_.AllNames(); }});
  slots_.Declare({.name = "Speaker.languages",
                  .grammar = "<text>",
                  .access = vm::Access::kReadOnly,
                  .help = "Which speakers there are for which language: CODE SPEAKER..., with ; "
                          "between, as in: en slt rms; de espeak-de.",
                  .on_inq = [this] { return SpeakersByLanguage(engine_->voices()); }});
  slots_.Declare({.name = "Speaker.language",
                  .grammar = "<word> <word>",
                  .access = vm::Access::kWriteOnly,
                  .help = "LANGUAGE SPEAKER: who speaks the parts of a text that are in another "
                          "language than the speaker's, as in: ja espeak-ja.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    const VoiceInfo* wanted = speakers_.Find(value.word(1));
                    const std::string name = wanted ? wanted->name : value.word(1);
                    if (auto chosen = engine_->ChooseVoice(value.word(0), name); !chosen) {
                      return std::unexpected(chosen.error());
                    }
                    next_made_.reset();  // planned with the voice before
                    return value.text;
                  },
                  .saved = false});
  DeclareRefused("Alpha", "this engine has no frequency warping to set", false);
  DeclareRefused("Postfilter", "this engine has no postfilter to set", false);

  const auto factor = [this](std::string name, std::string grammar, std::string help,
                             double& number) {
    slots_.Declare(
        {.name = std::move(name),
         .grammar = std::move(grammar),
         .initial = "1",
         .auto_output = true,
         .help = std::move(help),
         .on_set = [this, &number](const vm::SetValue& value) -> vm::Result<std::string> {
           if (&number == &pitch_ && value.number(0) != 1 && !voice_.pitch_adjustable) {
             return vm::Fail(vm::Errc::kUnavailable,
                             "the pitch of voice '" + voice_.name + "' cannot be changed");
           }
           number = value.number(0);
           return FormatFactor(number);
         }});
  };
  factor("Rate", "<number 0.25..4>", "Speed of speech from the next Text on; 2 is twice as fast.",
         rate_);
  factor("Pitch", "<number 0.5..2>",
         "Pitch of the voice from the next Text on; 2 is an octave higher. 1 is the speaker's own.",
         pitch_);
  factor("Volume", "<number 0..4>",
         "Loudness from the next Text on, as a factor of the amplitude; samples beyond 16 bit are "
         "cut.",
         volume_);
}

void VoiceModule::DeclareEmotion() {
  slots_.Declare(
      {.name = "Emotion",
       .grammar =
           "(NEUTRAL | HAPPY | ANGRY | DISGUSTED | SAD | SURPRISED | FEARED) [<number 0..100>]",
       .initial = "NEUTRAL",
       .auto_output = true,
       .help = "How the speaker feels, with a strength in % (100 without one), from the next Text "
               "on: a voice that has voice files for emotions is mixed with the emotion's; others "
               "change speed, pitch and loudness, beside Rate, Pitch and Volume.",
       .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
         const double strength = value.size() > 1 ? value.number(1) : 100;
         feeling_ = {value.word(0), strength / 100,
                     MannerOf(value.word(0), strength).value_or(Manner{})};
         return value.size() > 1 ? value.word(0) + " " + FormatFactor(strength) : value.word(0);
       }});
}

}  // namespace ssm
