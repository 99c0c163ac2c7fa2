#include "face_track/live/live_tracker.h"

#include <boost/asio/post.hpp>
#include <utility>

namespace facetrack {

LiveTracker::LiveTracker(boost::asio::io_context& io, std::unique_ptr<PictureSource> source,
                         bool paced, std::unique_ptr<Looker> looker, Events events)
    : io_(io),
      source_(std::move(source)),
      paced_(paced),
      looker_(std::move(looker)),
      events_(std::make_shared<Events>(std::move(events))),
      reader_([this] { Read(); }),
      viewer_([this] { LookAtAll(); }) {}

LiveTracker::~LiveTracker() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  source_->Stop();
  changed_.notify_all();
  reader_.join();
  viewer_.join();
}

void LiveTracker::Read() {
  const Clock::time_point begun = Clock::now();
  TimedPicture picture;
  while (true) {
    const auto more = source_->Next(picture);
    std::unique_lock lock(mutex_);
    if (!more) error_ = more.error();
    if (!more || !*more) ended_ = true;
    if (!ended_ && !paced_) {
      const auto due = begun + std::chrono::microseconds(static_cast<long>(1000 * picture.ms));
      changed_.wait_until(lock, due, [this] { return stopped_; });
    }
    if (stopped_) return;
    if (!ended_) {
      // The memory of a picture nobody looked at is used for the next one.
      if (!newest_) newest_.emplace();
      std::swap(newest_->picture, picture);
      newest_->at = Clock::now();
    }
    changed_.notify_all();
    if (ended_) return;
  }
}

void LiveTracker::LookAtAll() {
  Tracker& tracker = looker_->tracker;
  while (true) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return stopped_ || newest_ || ended_; });
    if (stopped_) return;
    if (!newest_) break;
    const Arrived arrived = *std::exchange(newest_, std::nullopt);
    lock.unlock();
    Moment moment{.lines = tracker.Look(arrived.picture.picture, arrived.picture.ms)};
    moment.taken = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - arrived.at);
    Tell([moment = std::move(moment)](const Events& events) { events.moment(moment); });
  }
  Moment last{.lines = tracker.Finish()};
  if (!last.lines.empty()) {
    Tell([last = std::move(last)](const Events& events) { events.moment(last); });
  }
  Tell([error = error_](const Events& events) { events.over(error); });
}

void LiveTracker::Tell(std::function<void(const Events&)> what) {
  boost::asio::post(io_, [events = std::weak_ptr(events_), what = std::move(what)] {
    if (const auto still = events.lock()) what(*still);
  });
}

}  // namespace facetrack
