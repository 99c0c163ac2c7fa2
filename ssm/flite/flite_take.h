#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "ssm/flite/flite_library.h"

namespace ssm {

/// A sentence being spoken by flite on a thread of its own: what it is made of is known before the
/// sound is, and the sound goes on being made while the rest of the text is looked at. Planning a
/// sentence and speaking it apart costs the first half of the work twice, and that is what somebody
/// waits for.
/// Thread: owns one, ended and joined by the destructor. The calls are for one other thread.
class FliteTake {
 public:
  explicit FliteTake(FliteSentence sentence);
  ~FliteTake();
  FliteTake(const FliteTake&) = delete;

  /// Waits for the analysis; none if flite cannot read the sentence.
  std::optional<FliteAnalysis> Analysis();
  /// Hands over the sound from its beginning as it comes, until all was or `take` returns false.
  void Sound(const std::function<bool(std::span<const std::int16_t>)>& take);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  // Guarded by mutex_.
  std::optional<FliteAnalysis> analysis_;
  std::vector<std::int16_t> samples_;
  bool done_ = false;
  bool given_up_ = false;
  std::thread thread_;  // the last: it uses all above
};

}  // namespace ssm
