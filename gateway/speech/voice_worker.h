#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gateway/speech/speech_answer.h"
#include "ssm/process/voice_process.h"

namespace gateway {

/// A voice of our own, which speaks one text after the other.
/// Thread: the context's; one of its own waits for the voice and makes the
/// answer, and is joined at the end. Lifetime:
/// context and network outlive it. Limits: kMostWaiting texts, and `limit` for each.
class VoiceWorker {
 public:
  static constexpr std::size_t kMostWaiting = 8;
  using Done = std::function<void(vm::Result<SpeechAnswer> answer)>;

  VoiceWorker(boost::asio::io_context& io, std::vector<std::string> command,
              std::chrono::milliseconds limit, const vdm::MouthNet& net);
  ~VoiceWorker();
  VoiceWorker(const VoiceWorker&) = delete;

  /// Calls `done` once, later; not after the end of this object. Errors of `done`: the voice's own
  /// (kBadValue: there is no such voice), kUnavailable, kTimeout. At once: kLimit, so many wait.
  /// Returns the text's number.
  vm::Result<std::uint64_t> Speak(SpeechRequest request, Done done);
  /// Nobody waits for that text any more: it is not spoken, unless it is just being.
  void Forget(std::uint64_t text);

 private:
  struct Job {
    std::uint64_t number = 0;
    SpeechRequest request{};
    Done done{};
  };
  void Run();

  // Constant after construction.
  boost::asio::io_context& io_;
  const vdm::MouthNet& net_;
  const std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // the context's thread alone
  std::atomic<bool> cancelled_ = false;
  ssm::VoiceProcess voice_;  // the worker's own
  // Guarded by the mutex.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  std::uint64_t last_number_ = 0;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace gateway
