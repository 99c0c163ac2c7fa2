#include "ssm/process/voice_process.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ssm/engines/wav_piece.h"
#include "vm_protocol/core/client.h"
#include "vm_protocol/core/message.h"

namespace ssm {

vm::Result<Spoken> VoiceProcess::Speak(const Words& words) {
  const TemporaryFolder folder;
  for (int attempt = 0;; ++attempt) {
    auto spoken = SpeakOnce(words, folder.File("spoken.wav"));
    if (spoken || std::exchange(refused_, false)) return spoken;
    process_.reset();
    // It may have died long ago; a new one gets the same text once.
    if (attempt > 0 || spoken.error().code != vm::Errc::kUnavailable) return spoken;
  }
}

vm::Result<Spoken> VoiceProcess::SpeakOnce(const Words& words, const std::string& wav) {
  const ChildProcess::Wait wait{ChildProcess::Clock::now() + limit_, cancelled_};
  if (!process_) {
    auto started = ChildProcess::Start(command_, false);
    if (!started) return std::unexpected(started.error());
    process_ = std::move(*started);
    auto first = Request("inq#{} Speaker", wait);
    if (!first) return std::unexpected(first.error());
    first_voice_ = std::move(*first);
  }
  Spoken spoken;
  std::string phonemes;
  for (const std::string& line :
       {"set#{} Speaker = " + (words.voice.empty() ? first_voice_ : words.voice),
        fmt::format("set#{{}} Rate = {:.3g}", words.speed), "set#{} Text = " + words.text,
        "set#{} SaveWAV = " + wav, std::string("inq#{} Text.pho")}) {
    auto answer = Request(line, wait);
    if (!answer) return std::unexpected(answer.error());
    phonemes = std::move(*answer);
  }
  auto list = vm::ParsePhonemes(phonemes);
  auto samples = ReadSoundFile(wav);
  if (!list || !samples) {
    return std::unexpected(list ? samples.error() : list.error());
  }
  return Spoken{std::move(*samples), std::move(*list)};
}

vm::Result<std::string> VoiceProcess::Request(const std::string& line,
                                              const ChildProcess::Wait& wait) {
  const std::string tag = std::to_string(++last_tag_);
  std::string tagged = line;
  tagged.replace(tagged.find("{}"), 2, tag);
  std::ranges::replace_if(
      tagged, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  if (auto sent = process_->Write(tagged + "\n", wait); !sent) {
    return std::unexpected(sent.error());
  }
  while (true) {
    auto came = process_->ReadLine(wait);
    if (!came) return std::unexpected(came.error());
    const auto message = vm::ParseMessage(*came);
    if (!message || message->tag != tag) continue;
    if (!message->slot.ends_with(".error") && message->slot != "Error") return message->value;
    refused_ = true;
    return std::unexpected(vm::ParseError(message->value));
  }
}

}  // namespace ssm
