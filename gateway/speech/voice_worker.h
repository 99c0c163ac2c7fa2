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
#include "ssm/process/child_process.h"

namespace gateway {

/// A voice module (ssm) of our own, spoken to in the protocol over its standard input and output:
/// started when first needed, kept, started anew after it failed. One text after the other.
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
  vm::Result<Spoken> Ask(const SpeechRequest& request);
  vm::Result<Spoken> AskOnce(const SpeechRequest& request, const std::string& wav);
  /// The value a request is answered with.
  vm::Result<std::string> Request(const std::string& line, const ssm::ChildProcess::Wait& wait);

  // Constant after construction.
  boost::asio::io_context& io_;
  const std::vector<std::string> command_;
  const std::chrono::milliseconds limit_;
  const vdm::MouthNet& net_;
  const std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // the context's thread alone
  // The worker's own.
  std::unique_ptr<ssm::ChildProcess> process_;
  unsigned last_tag_ = 0;
  bool refused_ = false;  // the last error is the voice's own word
  std::string first_voice_;
  // Guarded by the mutex.
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  std::uint64_t last_number_ = 0;
  bool stopping_ = false;
  std::atomic<bool> cancelled_ = false;
  std::thread thread_;
};

}  // namespace gateway
