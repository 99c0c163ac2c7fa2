// What the voice module writes to files and reads from them.

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "ssm/voice/parsed_text.h"
#include "ssm/voice/prosody.h"
#include "ssm/voice/ssml.h"
#include "ssm/voice/voice_module.h"
#include "vm_protocol/core/file_kind.h"

namespace ssm {

void VoiceModule::Save(const std::string& path, SoundFormat format, const vm::Reply& reply) {
  if (!utterance_) {
    return reply.Fail({vm::Errc::kBusy, "there is nothing to save; set Text first", 0});
  }
  auto save = [path, format, reply, utterance = utterance_] {
    // `Save = FILE.wav` is a WAV file whatever the slot, with a label file for other programs.
    const bool wav = format == SoundFormat::kWav || path.ends_with(".wav");
    auto saved = SaveUtterance(*utterance, path, wav ? SoundFormat::kWav : format);
    if (saved && wav) saved = SaveLabels(*utterance, path + ".lab");
    if (!saved) return reply.Fail(saved.error());
    reply.Ok(path);
  };
  if (utterance_->samples->complete()) return save();
  waiting_for_sound_.push_back({std::move(save), reply});
}

/// A client of the original waits for `rep Save = FILE`.
void VoiceModule::SaveAndTell(const std::string& path, SoundFormat format, const vm::Reply& reply) {
  Save(path, format, vm::Reply([this, reply](vm::Result<std::string> saved) {
         if (!saved) return reply.Fail(saved.error());
         slots_.Report("Save", *saved);
         reply.Ok(*saved);
       }));
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

// --- the original's files of intonation and of analyses made by hand

void VoiceModule::SavePros(const std::string& path, SoundFormat, const vm::Reply& reply) {
  if (!utterance_) {
    return reply.Fail({vm::Errc::kBusy, "there is nothing to save; set Text first", 0});
  }
  auto save = [path, reply, utterance = utterance_] {
    if (auto saved = WriteProsody(ProsodyOf(*utterance), path); !saved) {
      return reply.Fail(saved.error());
    }
    reply.Ok(path);
  };
  if (utterance_->samples->complete()) return save();
  waiting_for_sound_.push_back({std::move(save), reply});
}

void VoiceModule::LoadPros(const std::string& path, SoundFormat, const vm::Reply& reply) {
  if (player_.active() || state_ == State::kPaused) {
    return reply.Fail({vm::Errc::kBusy, "speaking; wait for Speak.stat = IDLE", 0});
  }
  auto prosody = ReadProsody(path);
  if (!prosody) return reply.Fail(prosody.error());
  const std::string text = prosody->text;
  slots_.Report("ProsFile", path);
  Prepare(text, reply, std::make_shared<const Prosody>(std::move(*prosody)));
}

void VoiceModule::LoadParsed(const std::string& path, SoundFormat, const vm::Reply& reply) {
  if (auto fit = vm::CheckReadable(path); !fit) return reply.Fail(fit.error());
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return reply.Fail(
        {vm::Errc::kUnavailable, "cannot read '" + path + "': " + std::strerror(errno), 0});
  }
  std::string xml(kMaxTextBytes * 16, '\0');
  file.read(xml.data(), static_cast<std::streamsize>(xml.size()));
  xml.resize(static_cast<std::size_t>(file.gcount()));
  auto text = TextOfParsed(xml);
  if (!text) {
    return reply.Fail({text.error().code, "'" + path + "': " + text.error().text, 0});
  }
  SetText(*text, reply);
}

// --- a text made ready while another is spoken

void VoiceModule::SetNext(const std::string& text, const vm::Reply& reply) {
  if (!player_.active() && state_ != State::kPaused) return SetText(text, reply);
  if (text.size() > kMaxTextBytes) return reply.Fail(TooLong(text));
  auto read = ReadText(text);
  if (!read) return reply.Fail(read.error());
  DropNext("another text came to be the next");
  auto next = std::make_shared<Preparation>(
      Preparation{.utterance = std::make_shared<Utterance>(
                      Utterance{.text = text, .spoken_text = std::move(read->plain)}),
                  .spans = Manners(std::move(read->spans)),
                  .cancelled = std::make_shared<std::atomic<bool>>(false),
                  .reply = reply,
                  .wanted = WantedNow(text)});
  next_ = next;
  worker_->Run([this, next] { next->plan = engine_->Plan(next->spans, *next->cancelled); },
               [this, next, alive = std::weak_ptr<bool>(alive_)] {
                 if (alive.expired() || next_ != next) return;
                 next->planned = true;
                 if (next->plan) {
                   next->reply.Ok(next->utterance->text);
                   return TakeNext();
                 }
                 next->reply.Fail(next->plan.error());
                 DropNext("its text cannot be spoken");
               });
}

void VoiceModule::DropNext(const char* why) {
  if (!next_) return;
  *next_->cancelled = true;
  next_->reply.Fail({vm::Errc::kStopped, why, 0});
  Abandon(next_->after, why);
  next_.reset();
}

/// The text made ready becomes the present one, with the usual reports.
void VoiceModule::TakeNext() {
  if (!next_ || !next_->planned || state_ != State::kIdle || player_.active()) return;
  const auto next = std::exchange(next_, nullptr);
  if (utterance_) utterance_->samples->Cancel();
  utterance_.reset();
  SetState(State::kProcessing);
  slots_.Store("Text", next->utterance->text);
  slots_.Report("Text.text", next->utterance->text);
  slots_.Report("Speak.text", next->utterance->spoken_text);
  preparation_ = next;
  OnPlanned(next);
  if (!utterance_) return Abandon(next->after, "its text cannot be spoken");
  next_wanted_ = next->wanted;
  next_made_ = utterance_;
  for (auto queue = std::exchange(next->after, {}); !queue.empty(); queue.pop_front()) {
    queue.front().action();
  }
}

std::string VoiceModule::WantedNow(const std::string& text) const {
  return voice_.name + " " + std::to_string(rate_) + " " + std::to_string(pitch_) + " " +
         std::to_string(volume_) + " " + feeling_.name + " " + std::to_string(feeling_.strength01) +
         " " + text;
}

/// A Text that is the next text, and that has been planned or is being planned already, costs no
/// further planning. So whoever only knows Text can have it prepared by Text.next.
bool VoiceModule::TakesNext(const std::string& text, const vm::Reply& reply) {
  const std::string wanted = WantedNow(text);
  if (next_ && next_->wanted == wanted && next_->after.empty()) {
    next_->after.push_back({[this, text, reply] { SetText(text, reply); }, reply});
    return true;
  }
  if (next_ || state_ != State::kReady || !utterance_ || utterance_ != next_made_ ||
      next_wanted_ != wanted || !waiting_.empty() || !waiting_for_sound_.empty())
    return false;
  SetState(State::kProcessing);
  slots_.Report("Text.text", text);
  slots_.Report("Speak.text", utterance_->spoken_text);
  ReportPhonemes();
  MakeReady(reply, text);
  return true;
}

vm::Result<std::string> VoiceModule::SetRecord(const std::string& path) {
  if (tape_) {
    if (player_.active()) AddToTape(player_.Where());
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

void VoiceModule::AddToTape(const AudioSink::Position& heard) {
  if (!tape_) return;
  const auto ready = playing_->Ready();
  auto added = tape_->Add(heard.first_frame, ready.first(std::min(heard.frames, ready.size())));
  if (added) return;
  tape_.reset();
  slots_.Store("Record", "STOP");
  Fault("Record", added.error());
}

}  // namespace ssm
