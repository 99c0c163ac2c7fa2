// What the voice module writes to files and reads from them.

#include <algorithm>
#include <utility>

#include "ssm/voice/voice_module.h"

namespace ssm {

void VoiceModule::Save(const std::string& path, SoundFormat format, const vm::Reply& reply) {
  if (!utterance_) {
    return reply.Fail({vm::Errc::kBusy, "there is nothing to save; set Text first", 0});
  }
  auto save = [path, format, reply, utterance = utterance_] {
    if (auto saved = SaveUtterance(*utterance, path, format); !saved) {
      return reply.Fail(saved.error());
    }
    reply.Ok(path);
  };
  if (utterance_->samples->complete()) return save();
  waiting_for_sound_.push_back({std::move(save), reply});
}

void VoiceModule::Load(const std::string& path, SoundFormat format, const vm::Reply& reply) {
  if (player_.active()) {
    return reply.Fail({vm::Errc::kBusy, "speaking; wait for Speak.stat = IDLE", 0});
  }
  auto loaded = LoadUtterance(path, format);
  if (!loaded) return reply.Fail(loaded.error());
  if (utterance_) utterance_->samples->Cancel();
  SetState(State::kProcessing);
  slots_.Report("SpeechFile", path);
  utterance_ = std::move(*loaded);
  slots_.Store("Text.text", utterance_->text);
  slots_.Store("Speak.text", utterance_->spoken_text);
  ReportPhonemes();
  MakeReady(reply, path);
}

vm::Result<std::string> VoiceModule::SetRecord(const std::string& path) {
  if (tape_) {
    if (player_.active()) AddToTape(*spoken_->samples, player_.Where());
    // (A failing file has been reported and dropped by now.)
    if (tape_) {
      auto closed = tape_->Close(scheduler_.Now());
      tape_.reset();
      if (!closed) return std::unexpected(closed.error());
    }
  }
  if (path == "STOP") return path;
  auto tape = Tape::Start(path, scheduler_.Now());
  if (!tape) {
    slots_.Store("Record", "STOP");
    return std::unexpected(tape.error());
  }
  tape_ = std::move(*tape);
  return path;
}

void VoiceModule::AddToTape(const SampleBuffer& samples, const AudioSink::Position& heard) {
  if (!tape_) return;
  const auto ready = samples.Ready();
  auto added = tape_->Add(heard.first_frame, ready.first(std::min(heard.frames, ready.size())));
  if (added) return;
  tape_.reset();
  slots_.Store("Record", "STOP");
  Fault("Record", added.error());
}

}  // namespace ssm
