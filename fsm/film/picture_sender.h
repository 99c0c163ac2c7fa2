#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// Compresses pictures and says them to a program that listens at a Unix socket, from a thread of
/// its own, so that nobody waits for the receiver: docs/face.md, Pictures for other programs.
/// Ownership: owns its end of the socket. Thread: one caller.
/// Limits: one picture is being sent and one waits; a receiver that has taken nothing for `stall`
/// is cut off.
class PictureSender {
 public:
  static constexpr std::chrono::milliseconds kStall{2000};
  static constexpr int kQuality = 80;  // JPEG

  /// Error: kUnavailable if nobody listens at `path`.
  static vm::Result<std::unique_ptr<PictureSender>> Connect(
      const std::string& path, std::chrono::milliseconds stall = kStall);
  /// Drops what waits.
  ~PictureSender();
  PictureSender(const PictureSender&) = delete;
  PictureSender& operator=(const PictureSender&) = delete;

  /// A picture waits: another one would be late.
  bool full();
  /// The receiver has closed, or was cut off.
  bool gone();
  /// The picture of the instant `at`, opaque. REQUIRES: not full.
  void Send(const Image& picture, vm::Time at);

 private:
  PictureSender(int fd, std::chrono::milliseconds stall)
      : fd_(fd), stall_(stall), thread_([this] { Run(); }) {}
  void Run();
  /// False once there is nobody to send to.
  bool SendAll(const std::vector<std::uint8_t>& bytes);
  bool closing();

  const int fd_;
  const std::chrono::milliseconds stall_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  std::optional<std::pair<vm::Time, Image>> waiting_;
  Image spare_;  // memory that was used before
  bool closing_ = false;
  bool gone_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace fsm
