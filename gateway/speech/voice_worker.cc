#include "gateway/speech/voice_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

#include "ssm/engines/wav_piece.h"
#include "vm_protocol/core/client.h"
#include "vm_protocol/core/message.h"

namespace gateway {

using ssm::ChildProcess;
using vm::Errc;

VoiceWorker::VoiceWorker(boost::asio::io_context& io, std::vector<std::string> command,
                         std::chrono::milliseconds limit, const vdm::MouthNet& net)
    : io_(io), command_(std::move(command)), limit_(limit), net_(net), thread_([this] { Run(); }) {}

VoiceWorker::~VoiceWorker() {
  *alive_ = false;
  cancelled_ = true;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

vm::Result<std::uint64_t> VoiceWorker::Speak(SpeechRequest request, Done done) {
  const std::lock_guard lock(mutex_);
  if (jobs_.size() >= kMostWaiting) {
    return vm::Fail(Errc::kLimit, std::to_string(kMostWaiting) + " texts wait for the voice");
  }
  jobs_.push_back({++last_number_, std::move(request), std::move(done)});
  wake_.notify_one();
  return last_number_;
}

void VoiceWorker::Forget(std::uint64_t text) {
  Job forgotten;  // its end must not meet the lock
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(jobs_, text, &Job::number);
  if (found == jobs_.end()) return;
  forgotten = std::move(*found);
  jobs_.erase(found);
}

void VoiceWorker::Run() {
  while (true) {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (stopping_) return;
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    auto spoken = Ask(job.request);
    auto answer = std::make_shared<vm::Result<SpeechAnswer>>(
        spoken ? MakeSpeechAnswer(job.request, *spoken, net_, cancelled_)
               : std::unexpected(spoken.error()));
    boost::asio::post(io_, [alive = alive_, answer, done = std::move(job.done)] {
      if (*alive) done(std::move(*answer));
    });
  }
}

vm::Result<Spoken> VoiceWorker::Ask(const SpeechRequest& request) {
  const ssm::TemporaryFolder folder;
  for (int attempt = 0;; ++attempt) {
    auto spoken = AskOnce(request, folder.File("spoken.wav"));
    if (spoken || std::exchange(refused_, false)) return spoken;
    process_.reset();
    // It may have died long ago; a new one gets the same text once.
    if (attempt > 0 || spoken.error().code != Errc::kUnavailable) return spoken;
  }
}

vm::Result<Spoken> VoiceWorker::AskOnce(const SpeechRequest& request, const std::string& wav) {
  const ChildProcess::Wait wait{ChildProcess::Clock::now() + limit_, &cancelled_};
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
       {"set#{} Speaker = " + (request.voice.empty() ? first_voice_ : request.voice),
        fmt::format("set#{{}} Rate = {:.3g}", request.speed), "set#{} Text = " + request.text,
        "set#{} SaveWAV = " + wav, std::string("inq#{} Text.pho")}) {
    auto answer = Request(line, wait);
    if (!answer) return std::unexpected(answer.error());
    phonemes = std::move(*answer);
  }
  auto list = vm::ParsePhonemes(phonemes);
  auto samples = ssm::ReadSoundFile(wav);
  if (!list || !samples) {
    return std::unexpected(list ? samples.error() : list.error());
  }
  return Spoken{std::move(*samples), std::move(*list)};
}

vm::Result<std::string> VoiceWorker::Request(const std::string& line,
                                             const ChildProcess::Wait& wait) {
  const std::string tag = std::to_string(++last_tag_);
  std::string tagged = line;
  tagged.replace(tagged.find("{}"), 2, tag);
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

}  // namespace gateway
