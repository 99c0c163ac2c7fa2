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

/// Compresses pictures as JPEG and sends them to a program that listens at a Unix socket, from a
/// separate thread, so that the caller never waits for the receiver. The format is in docs/face.md,
/// Pictures for other programs.
/// Ownership: owns its end of the socket. Thread: one caller.
/// Limits: one picture is being sent and one waits; a receiver that reads nothing for kStall is
/// disconnected.
class PictureSender {
 public:
  static constexpr std::chrono::milliseconds kStall{2000};
  static constexpr int kQuality = 80;  // JPEG

  /// Error: kUnavailable if nobody listens at `path`.
  static vm::Result<std::unique_ptr<PictureSender>> Connect(
      const std::string& path, std::chrono::milliseconds stall = kStall);
  /// Drops the waiting picture.
  ~PictureSender();
  PictureSender(const PictureSender&) = delete;
  PictureSender& operator=(const PictureSender&) = delete;

  /// Tells whether a picture is waiting, so that another one would be late.
  bool full();
  /// Tells whether the receiver has closed the connection or was disconnected.
  bool gone();
  /// Queues a picture of the instant `at`; alpha is ignored. REQUIRES: not full.
  void Send(const Image& picture, vm::Time at);

 private:
  PictureSender(int fd, std::chrono::milliseconds stall)
      : fd_(fd), stall_(stall), thread_([this] { Run(); }) {}
  void Run();
  /// Returns false once the receiver is gone.
  bool SendAll(const std::vector<std::uint8_t>& bytes);
  bool closing();

  const int fd_;
  const std::chrono::milliseconds stall_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  std::optional<std::pair<vm::Time, Image>> waiting_;
  Image spare_;  // reused memory
  bool closing_ = false;
  bool gone_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace fsm
