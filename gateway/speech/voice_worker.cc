#include "gateway/speech/voice_worker.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

namespace gateway {

using vm::Errc;

VoiceWorker::VoiceWorker(boost::asio::io_context& io, std::vector<std::string> command,
                         std::chrono::milliseconds limit, const vdm::MouthNet& net)
    : io_(io),
      net_(net),
      voice_(std::move(command), limit, &cancelled_),
      thread_([this] { Run(); }) {}

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
    const auto speak = [&](const std::string& voice) {
      return voice_.Speak({.text = job.request.text, .voice = voice, .speed = job.request.speed});
    };
    auto spoken = speak(job.request.voice);
    // A voice of ours may bear such a name; else whatever there is speaks.
    if (!spoken && spoken.error().code == Errc::kBadValue && IsVoiceOfOpenAi(job.request.voice))
      spoken = speak("");
    auto answer = std::make_shared<vm::Result<SpeechAnswer>>(
        spoken ? MakeSpeechAnswer(job.request, *spoken, net_, cancelled_)
               : std::unexpected(spoken.error()));
    boost::asio::post(io_, [alive = alive_, answer, done = std::move(job.done)] {
      if (*alive) done(std::move(*answer));
    });
  }
}

}  // namespace gateway
