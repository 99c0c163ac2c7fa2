#include "hypermask/live/live_pictures.h"

#include <boost/asio/post.hpp>
#include <utility>

namespace hypermask {

LivePictures::LivePictures(boost::asio::io_context& io,
                           std::unique_ptr<facetrack::PictureSource> source, bool paced,
                           Events events)
    : io_(io),
      source_(std::move(source)),
      paced_(paced),
      events_(std::make_shared<Events>(std::move(events))),
      reader_([this] { Read(); }) {}

LivePictures::~LivePictures() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  source_->Stop();
  changed_.notify_all();
  reader_.join();
}

void LivePictures::Read() {
  const Clock::time_point begun = Clock::now();
  facetrack::TimedPicture picture;
  while (true) {
    const auto more = source_->Next(picture);
    std::unique_lock lock(mutex_);
    if (stopped_) return;
    if (!more || !*more) {
      // What was told before is taken before.
      boost::asio::post(io_, [events = std::weak_ptr(events_),
                              error = more ? std::nullopt : std::optional(more.error())] {
        if (const auto still = events.lock()) still->over(error);
      });
      return;
    }
    if (!paced_) {
      const auto due = begun + std::chrono::microseconds(static_cast<long>(1000 * picture.ms));
      changed_.wait_until(lock, due, [this] { return stopped_; });
      if (stopped_) return;
    }
    std::swap(newest_, picture.picture);
    arrived_ = Clock::now();
    if (!std::exchange(waiting_, true)) {
      boost::asio::post(io_, [this, events = std::weak_ptr(events_)] {
        if (!events.expired()) Hand();
      });
    }
  }
}

void LivePictures::Hand() {
  Clock::time_point arrived;
  fsm::Image picture;
  {
    const std::lock_guard lock(mutex_);
    waiting_ = false;
    arrived = arrived_;
    std::swap(picture, newest_);
  }
  const auto events = events_;  // one of them may end this
  events->picture(picture, arrived);
}

}  // namespace hypermask
