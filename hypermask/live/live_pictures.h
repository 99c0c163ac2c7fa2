#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "face_track/film/picture_source.h"

namespace hypermask {

/// Hands over pictures while they come: a camera's as they come, a film's or folder's at its own
/// pace, or as fast as they are taken. Always the newest one: those that came while the loop was
/// busy are left out. Thread: owns one that reads, joined by the destructor; events come on the
/// io_context's, and none after the destructor.
class LivePictures {
 public:
  using Clock = std::chrono::steady_clock;
  struct Events {
    /// The picture and when it was there.
    std::function<void(const fsm::Image& picture, Clock::time_point arrived)> picture{};
    /// There are no more pictures; why, if not because that was all.
    std::function<void(const std::optional<vm::Error>& error)> over{};
  };
  /// `paced`: the source gives its pictures at its own pace (facetrack::IsLive).
  LivePictures(boost::asio::io_context& io, std::unique_ptr<facetrack::PictureSource> source,
               bool paced, Events events);
  ~LivePictures();
  LivePictures(const LivePictures&) = delete;

 private:
  void Read();
  void Hand();

  // Constant after construction; the events are used on the loop's thread alone.
  boost::asio::io_context& io_;
  const std::unique_ptr<facetrack::PictureSource> source_;
  const bool paced_;
  const std::shared_ptr<Events> events_;

  // Guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  fsm::Image newest_;
  Clock::time_point arrived_;
  bool waiting_ = false;  // newest_ was told of and not yet taken
  bool stopped_ = false;

  std::thread reader_;  // last: it uses all of the above
};

}  // namespace hypermask
