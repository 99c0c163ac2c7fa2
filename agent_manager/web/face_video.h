#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "agent_manager/routing/hub.h"
#include "agent_manager/web/live_piece.h"
#include "agent_manager/web/private_folder.h"

namespace am {

/// The live face as JPEG pictures, recorded only while there are viewers. The face writes raw
/// frames into a pipe (`set Record = PIPE.rgba`), as for any film, and says when the first of them
/// is (`Record.start`); where it does not, pictures have the time at which they came. While it
/// records a film for somebody else, there is no video. Lifetime: `clock`, `io` and `hub` outlive
/// it. It owns the pipe, both descriptors and the thread. Thread: the context's, and one of its own
/// that reads and compresses while there are viewers; it posts finished pictures back and is joined
/// when recording ends.
/// Limits: pictures of 8192 x 8192 and 4096 * 4096 pixels. Errors: end the video with a sentence.
class FaceVideo {
 public:
  static constexpr int kFramesPerSecond = 25;
  FaceVideo(const vm::Scheduler& clock, boost::asio::io_context& io, Hub& hub);
  ~FaceVideo();
  FaceVideo(const FaceVideo&) = delete;

  unsigned Watch(Audience::Member viewer);
  void Leave(unsigned viewer);

 private:
  void Begin();
  void Ask(const std::string& slot, const std::string& value,
           std::function<void(const vm::Result<std::string>&)> next);
  void Open(int width, int height);
  void AskStart();
  void ReadFrames(int width, int height);       // runs on thread_
  void Post(long number, std::string picture);  // Deliver, from there; EndFrames if it is empty
  void Deliver(long number, std::string picture);
  void EndFrames();
  void GiveUp(const std::string& why);
  /// Asks the face to stop, and goes on reading until it has: a pipe closed before that would be an
  /// error in the face.
  void Stop();
  void End();

  const vm::Scheduler& clock_;
  boost::asio::io_context& io_;
  Hub& hub_;
  Audience viewers_;
  PrivateFolder folder_;             // of the pipe
  std::optional<vm::Time> started_;  // the first frame's instant on the face's clock
  std::string old_fps_;
  bool beginning_ = false, recording_ = false, stopping_ = false;
  std::thread thread_;
  int frames_fd_ = -1;  // read end of the pipe
  int stop_fd_ = -1;    // eventfd that ends the thread
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace am
