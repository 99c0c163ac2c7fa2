// What can be told and asked of head and emotion.

#include <fmt/format.h>

#include <cmath>

#include "vdm/core/movement_module.h"

namespace vdm {
namespace {

std::string UpperCase(std::string text) {
  for (char& c : text) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return text;
}

}  // namespace

void MovementModule::DeclareHead() {
  slots_.Declare(
      {.name = "Head.auto",
       .grammar = "ON | PROSODY | OFF",
       .initial = "OFF",
       .help = "Whether head and brows move with the voice, in MouthFrame: ON, by pitch, power and "
               "the sounds heard; PROSODY, by the network of the original's papers, which knows "
               "pitch, power and the position in the phrase alone. Not while Mouth.mode is OFF. "
               "The head is 60 ms late; with a Delay that is so much longer than need be (160) it "
               "is not.",
       .on_set = [this](const vm::SetValue& value) { return SetHead(value.word(0)); }});
  slots_.Declare({.name = "Head.size",
                  .grammar = "<number 0..300>",
                  .initial = "100",
                  .help = "How far head and brows move with the voice, in per cent.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    manner_settings_.head_size = static_cast<float>(value.number(0) / 100);
                    return value.word(0);
                  }});
  slots_.Declare({.name = "Head.emotion",
                  .grammar = "AUTO | <number 0..1>",
                  .initial = "AUTO",
                  .help = "How lively the head moves: 0 calm to 1 lively; AUTO: as likely as the "
                          "voice is aroused, where Emotion.auto is ON, else 0.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    manner_settings_.emotion =
                        value.word(0) == "AUTO"
                            ? std::nullopt
                            : std::optional(static_cast<float>(value.number(0)));
                    return value.word(0);
                  }});
}

void MovementModule::DeclareEmotion() {
  slots_.Declare({.name = "Emotion.auto",
                  .grammar = "ON | OFF",
                  .initial = "OFF",
                  .help = "Whether the voice says how its speaker feels (Emotion), and the face "
                          "shows it slightly by its slot Mood. Learned from synthetic speech alone "
                          "and never tried on people's emotions: so it is off.",
                  .on_set = [this](const vm::SetValue& value) -> vm::Result<std::string> {
                    emotion_on_ = value.word(0) == "ON";
                    Renew(true);
                    return value.word(0);
                  }});
  slots_.DeclareTold(
      "Emotion", "NONE",
      "After each phrase, while Emotion.auto is ON: MS on this module's clock, then CLASS "
      "LIKELIHOOD of neutral, aroused and low. NONE: nothing is claimed, as in silence, noise and "
      "music, and before some seconds of a voice were heard.",
      true);
  slots_.DeclareTold(
      "Prosody", "",
      "Each frame told, while Head.auto or Emotion.auto is on: MS, HZ (0: no voice), dB, then "
      "semitones and dB above the speaker's usual, and the position in the phrase, 0 to 1.");
}

vm::Result<std::string> MovementModule::SetHead(const std::string& word) {
  const HeadNet* const wanted = word == "ON"        ? options_.head
                                : word == "PROSODY" ? options_.head_by_prosody
                                                    : nullptr;
  if (wanted && wanted->sounds != 0 && wanted->sounds != net().sounds.size()) {
    return vm::Fail(vm::Errc::kUnavailable,
                    fmt::format("the head's network knows {} classes of sounds, the mouth's {}",
                                wanted->sounds, net().sounds.size()));
  }
  head_net_ = wanted;
  Renew(true);
  return word;
}

void MovementModule::TellEmotion() {
  if (!manner_ || !manner_->TakeEmotionChanged()) return;
  const std::vector<double>& likely = manner_->emotions();
  if (likely.empty()) {
    slots_.Report("Emotion", "NONE");
    return TellMood("NEUTRAL", 0);
  }
  std::string text = vm::FormatMs(scheduler_.Now());
  const auto& classes = options_.emotions->classes;
  std::size_t best = 0;
  for (std::size_t k = 0; k < likely.size(); ++k) {
    text += fmt::format(" {} {:.2f}", classes[k].name, likely[k]);
    if (likely[k] > likely[best]) best = k;
  }
  slots_.Report("Emotion", text);
  const bool plain = likely[best] < kMoodFrom || classes[best].name == "neutral";
  TellMood(plain ? "NEUTRAL" : UpperCase(classes[best].name), plain ? 0 : likely[best]);
}

void MovementModule::TellMood(const std::string& mood, double strength01) {
  if (mood == mood_ && std::abs(strength01 - mood_strength_) < kMoodStep) return;
  mood_ = mood;
  mood_strength_ = strength01;
  TellFace("Mood", mood == "NEUTRAL" ? mood : fmt::format("{} {:.0f}", mood, 100 * strength01));
}

void MovementModule::TellProsody(vm::Time at) {
  if (!manner_ || !slots_.AutoOutput("Prosody")) return;
  const ProsodyFrame& now = manner_->prosody();
  const SpeakerUsual& usual = manner_->stream().usual();
  const double semitones =
      now.hz > 0 ? 12 * std::log2(static_cast<double>(now.hz) / std::exp(usual.log_hz.mean())) : 0;
  slots_.Report("Prosody", fmt::format("{} {:.1f} {:.1f} {:.1f} {:.1f} {:.2f}", vm::FormatMs(at),
                                       now.hz, now.power_db, semitones,
                                       static_cast<double>(now.power_db) - usual.power_db.mean(),
                                       manner_->stream().phrases().position01()));
}

}  // namespace vdm
