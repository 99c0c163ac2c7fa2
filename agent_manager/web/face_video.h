#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "agent_manager/routing/hub.h"
#include "agent_manager/web/private_folder.h"

namespace am {

/// The live face as JPEG pictures, recorded only while there are viewers. The face writes raw
/// frames into a pipe (`set Record = PIPE.rgba`), as for any film; while it records a film for
/// somebody else, there is no video. Lifetime: `io` and `hub` outlive it. It owns the pipe, both
/// descriptors and the thread. Thread: the context's, and one of its own that reads and compresses
/// while there are viewers; it posts finished pictures back and is joined when recording ends.
/// Limits: pictures of 8192 x 8192 and 4096 * 4096 pixels. Errors: end the video with an empty
/// picture.
class FaceVideo {
 public:
  static constexpr int kFramesPerSecond = 15;
  using Picture = std::shared_ptr<const std::string>;
  /// An empty picture means that the video has ended.
  using OnPicture = std::function<void(const Picture& picture)>;
  FaceVideo(boost::asio::io_context& io, Hub& hub);
  ~FaceVideo();
  FaceVideo(const FaceVideo&) = delete;

  /// Calls `on_picture` for every picture until Leave, or until an empty one. Returns the viewer's
  /// number.
  unsigned Watch(OnPicture on_picture);
  void Leave(unsigned viewer);

 private:
  void Begin();
  void Ask(const std::string& slot, const std::string& value,
           std::function<void(const vm::Result<std::string>&)> next);
  void Open(int width, int height);
  void ReadFrames(int width, int height);  // runs on thread_
  void Post(std::string picture);          // Deliver, from there
  void Deliver(const Picture& picture);
  /// Asks the face to stop, and goes on reading until it has: a pipe closed before that would be an
  /// error in the face.
  void Stop();
  void End();

  boost::asio::io_context& io_;
  Hub& hub_;
  std::map<unsigned, OnPicture> viewers_;
  unsigned last_viewer_ = 0;
  PrivateFolder folder_;  // of the pipe
  std::string old_fps_;
  bool beginning_ = false, recording_ = false, stopping_ = false;
  std::thread thread_;
  int frames_fd_ = -1;  // read end of the pipe
  int stop_fd_ = -1;    // eventfd that ends the thread
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace am
