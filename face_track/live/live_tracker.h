#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "face_fit/find/network/attention_points.h"
#include "face_fit/find/network/face_networks.h"
#include "face_track/film/picture_source.h"
#include "face_track/follow/tracker.h"

namespace facetrack {

/// Follows a face while its pictures come: a camera's as they come, a film's or folder's at its own
/// pace. Always the newest picture is looked at, and those that came meanwhile are left out, so
/// that a slow machine shows the face less often and not later. Thread: owns two, one that reads
/// and one that looks, joined by the destructor; events come on the io_context's, and none after
/// the destructor.
class LiveTracker {
 public:
  struct Moment {
    std::vector<FaceLine> lines;        ///< the last is the newest
    std::chrono::microseconds taken{};  ///< from having the picture to this
  };
  struct Events {
    std::function<void(const Moment&)> moment;
    /// There are no more pictures; why, if not because that was all.
    std::function<void(const std::optional<vm::Error>& error)> over;
  };
  /// What tracks: the networks it needs live as long as it does. The face outlives it.
  struct Looker {
    facefit::FaceNetworks networks;
    facefit::AttentionNetwork attention;
    Tracker tracker;
    Looker(facefit::FaceNetworks n, facefit::AttentionNetwork a, const SeenFace& face,
           const Tracker::Settings& settings)
        : networks(std::move(n)),
          attention(std::move(a)),
          tracker(networks, attention, face, settings) {}
  };

  /// `paced`: the source gives its pictures at its own pace (IsLive).
  LiveTracker(boost::asio::io_context& io, std::unique_ptr<PictureSource> source, bool paced,
              std::unique_ptr<Looker> looker, Events events);
  ~LiveTracker();
  LiveTracker(const LiveTracker&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  struct Arrived {
    TimedPicture picture;
    Clock::time_point at;
  };
  void Read();
  void LookAtAll();
  void Tell(std::function<void(const Events&)> what);

  // Constant after construction; the events are used on the loop's thread alone.
  boost::asio::io_context& io_;
  const std::unique_ptr<PictureSource> source_;
  const bool paced_;
  const std::unique_ptr<Looker> looker_;  // used by the thread that looks
  const std::shared_ptr<Events> events_;

  // Guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Arrived> newest_;
  std::optional<vm::Error> error_;
  bool ended_ = false;    // no more pictures come
  bool stopped_ = false;  // nobody wants any

  std::thread reader_, viewer_;  // last: they use all of the above
};

}  // namespace facetrack
