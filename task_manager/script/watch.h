#pragma once

#include <chrono>
#include <condition_variable>
#include <ctime>
#include <functional>
#include <mutex>
#include <thread>

namespace vxml::script {

/// Looks from a thread of its own at what the thread that made it spends on a script, and asks to
/// interrupt the script when that is too much. While no script runs, its thread sleeps.
/// Thread: Begin and End on the thread that made it, never nested.
class Watch {
 public:
  enum class Verdict { kWell, kLate, kStarved };
  /// Of the script's processor time.
  static constexpr std::chrono::milliseconds kGrace{1000};

  /// `interrupt` is called on the watch's thread, again and again until End.
  explicit Watch(std::function<void()> interrupt);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  /// From now on this thread may use `time` of the processor, and the process `bytes` more memory.
  /// If that is too much, and kGrace later the script still has not let itself be interrupted,
  /// `on_stuck` is called on the watch's thread, if it is not empty; it lives until End.
  void Begin(std::chrono::nanoseconds time, std::size_t bytes,
             const std::function<void()>& on_stuck);
  Verdict End();
  /// What the watch has found so far since Begin.
  Verdict verdict();

 private:
  void Run();
  /// REQUIRES: mutex_ is held.
  Verdict Look();

  std::function<void()> interrupt_;
  clockid_t clock_{};
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  bool asleep_ = false;
  bool running_ = false;
  Verdict verdict_ = Verdict::kWell;
  std::chrono::nanoseconds latest_{};
  std::chrono::nanoseconds stuck_from_{};
  const std::function<void()>* on_stuck_ = nullptr;
  std::size_t bytes_ = 0;       // given by Begin
  std::size_t most_bytes_ = 0;  // 0: before the first look
  std::thread thread_;
};

/// What malloc has given out in this process, bytes.
std::size_t AllocatedBytes();

}  // namespace vxml::script
