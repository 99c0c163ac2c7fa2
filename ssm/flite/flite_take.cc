#include "ssm/flite/flite_take.h"

#include <utility>

namespace ssm {

FliteTake::FliteTake(FliteSentence sentence)
    : thread_([this, sentence = std::move(sentence)] {
        FliteLibrary::Speak(sentence, {.analysed =
                                           [this](FliteAnalysis analysis) {
                                             const std::lock_guard lock(mutex_);
                                             analysis_ = std::move(analysis);
                                             changed_.notify_all();
                                             return !given_up_;
                                           },
                                       .sound =
                                           [this](std::span<const std::int16_t> heard) {
                                             const std::lock_guard lock(mutex_);
                                             samples_.insert(samples_.end(), heard.begin(),
                                                             heard.end());
                                             changed_.notify_all();
                                             return !given_up_;
                                           }});
        const std::lock_guard lock(mutex_);
        done_ = true;
        changed_.notify_all();
      }) {}

FliteTake::~FliteTake() {
  {
    const std::lock_guard lock(mutex_);
    given_up_ = true;
  }
  thread_.join();
}

std::optional<FliteAnalysis> FliteTake::Analysis() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return analysis_ || done_; });
  return analysis_;
}

void FliteTake::Sound(const std::function<bool(std::span<const std::int16_t>)>& take) {
  std::size_t taken = 0;
  while (true) {
    std::vector<std::int16_t> more;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return done_ || samples_.size() > taken; });
      if (samples_.size() == taken) return;
      more.assign(samples_.begin() + static_cast<std::ptrdiff_t>(taken), samples_.end());
    }
    taken += more.size();
    if (!take(more)) return;
  }
}

}  // namespace ssm
