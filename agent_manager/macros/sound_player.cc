#include "agent_manager/macros/sound_player.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/xml_text.h"

namespace am {

using vm::Errc;
using vm::Result;

namespace {

constexpr const char* kVoice = "SSM";

}  // namespace

SoundPlayer::SoundPlayer(Hub& hub) : hub_(hub), slots_(own_name::kSound) {
  slots_.Declare({.name = "Play",
                  .grammar = "STOP | <file>",
                  .access = vm::Access::kWriteOnly,
                  .help = "Has the voice play a sound file after what it is speaking; `tell start "
                          "FILE` and `tell end FILE` say when. STOP ends it and forgets the next "
                          "ones.",
                  .on_set_later = [this](const vm::SetValue& value, const vm::Reply& reply) {
                    if (value.items[0].files.empty()) {
                      Drop({Errc::kStopped, "set Play = STOP came first", 0});
                      return reply.Ok("STOP");
                    }
                    Add(value.word(0), reply);
                  }});
}

void SoundPlayer::Handle(const Envelope& envelope) {
  origin_ = envelope.origin;
  slots_.Handle(envelope.message, envelope.machine.empty() ? envelope.origin.peer : kHub);
}

void SoundPlayer::Add(const std::string& name, const vm::Reply& reply) {
  std::error_code error;
  const auto path = std::filesystem::absolute(name, error);
  if (error || !std::filesystem::is_regular_file(path, error))
    return reply.Fail({Errc::kUnavailable, "there is no sound file '" + name + "'", 0});
  if (!hub_.directory().IsPresent(kVoice))
    return reply.Fail({Errc::kUnavailable, "there is no voice (@SSM) to play it", 0});
  if (files_.size() >= kMaxFiles)
    return reply.Fail(
        {Errc::kLimit, "more than " + std::to_string(kMaxFiles) + " files wait to be played", 0});
  files_.push_back({name, path.string(), reply, origin_});
  if (files_.size() == 1) Prepare();
}

void SoundPlayer::Prepare() {
  const File& file = files_.front();
  const std::string markup = "<speak><audio src=\"" + vm::EscapeXml(file.path) + "\"/></speak>";
  hub_.Ask(
      own_name::kSound, vm::To(kVoice, vm::Set("Text", markup)),
      [this, reply = file.reply](const Result<std::string>& taken) {
        if (reply.done()) return;  // dropped meanwhile
        if (taken) return Speak();
        reply.Fail(taken.error());
        End();
      },
      file.origin);
}

void SoundPlayer::Speak() {
  File& file = files_.front();
  file.state = File::State::kAsked;
  hub_.Ask(
      own_name::kSound, vm::To(kVoice, vm::Set("Speak", "NOW")),
      [this, reply = file.reply](const Result<std::string>& begun) {
        if (reply.done()) return;
        if (begun) return Begun();
        reply.Fail(begun.error());
        End();
      },
      file.origin);
}

void SoundPlayer::Begun() {
  File& file = files_.front();
  const bool over = std::exchange(file.state, File::State::kPlaying) == File::State::kOver;
  slots_.TellAll("start " + file.name);
  file.reply.Ok(file.name);
  if (!over) return;
  slots_.TellAll("end " + file.name);
  End();
}

void SoundPlayer::OnReport(const std::string& from, const vm::Message& message) {
  using enum File::State;
  if (from != kVoice || message.slot != "Speak.stat" || files_.empty()) return;
  File& file = files_.front();
  if (message.value == "SPEAKING" && file.state == kAsked) file.state = kHeard;
  if (message.value != "IDLE") return;
  if (file.state == kHeard) file.state = kOver;
  if (file.state != kPlaying) return;  // of its own speech before
  slots_.TellAll("end " + file.name);
  End();
}

void SoundPlayer::OnPresence(const std::string& name, bool present, const std::string&) {
  if (name == kVoice && !present) Drop({Errc::kUnavailable, "the voice (@SSM) has gone", 0});
}

bool SoundPlayer::IsAwaitedBy(PeerKey peer) const {
  return std::ranges::any_of(files_, [&](const File& file) { return file.origin.peer == peer; });
}

/// Removes the first file, and begins the next.
void SoundPlayer::End() {
  files_.pop_front();
  if (!files_.empty()) Prepare();
}

void SoundPlayer::Drop(const vm::Error& error) {
  auto files = std::exchange(files_, {});
  for (const File& file : files) {
    if (file.state == File::State::kPlaying) slots_.TellAll("end " + file.name);
    file.reply.Fail(error);
  }
  if (!files.empty() && hub_.directory().IsPresent(kVoice))
    hub_.Ask(own_name::kSound, vm::To(kVoice, vm::Set("Speak", "STOP")), IgnoreAnswer,
             files.front().origin);
}

}  // namespace am
