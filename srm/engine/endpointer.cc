#include "srm/engine/endpointer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace srm {
namespace {

constexpr Millis kFrame{10};
constexpr std::size_t kFrameSamples = 160;
// The noise follows quiet frames within some frames and loud ones within seconds.
constexpr double kFall = 0.3;
constexpr double kRiseDb = 0.03;
constexpr int kFirstFrames = 10;
constexpr double kLoudestNoiseDb = 60;

double LevelDb(std::span<const std::int16_t> frame) {
  double mean = 0, sum = 0;
  for (const std::int16_t sample : frame) mean += sample;
  mean /= static_cast<double>(frame.size());
  for (const std::int16_t sample : frame) sum += (sample - mean) * (sample - mean);
  return 10 * std::log10(sum / static_cast<double>(frame.size()) + 1);
}

}  // namespace

Endpointer::Endpointer(Settings settings, Events events)
    : settings_(settings), events_(std::move(events)) {}

void Endpointer::Feed(std::span<const std::int16_t> samples) {
  while (!samples.empty()) {
    const std::size_t wanted = std::min(kFrameSamples - partial_.size(), samples.size());
    partial_.insert(partial_.end(), samples.begin(),
                    samples.begin() + static_cast<std::ptrdiff_t>(wanted));
    samples = samples.subspan(wanted);
    if (partial_.size() < kFrameSamples) return;
    const std::vector<std::int16_t> frame = std::exchange(partial_, {});
    Frame(frame);
  }
}

bool Endpointer::IsSpeech(double level_db) {
  if (noise_frames_ < kFirstFrames) {
    noise_db_ = noise_frames_++ == 0 ? level_db : std::min(noise_db_, level_db);
    noise_db_ = std::min(noise_db_, kLoudestNoiseDb);
  } else if (level_db < noise_db_) {
    noise_db_ += kFall * (level_db - noise_db_);
  } else {
    noise_db_ = std::min(noise_db_ + kRiseDb, kLoudestNoiseDb);
  }
  return level_db > std::max(noise_db_ + settings_.above_noise_db, settings_.floor_db);
}

void Endpointer::Frame(std::span<const std::int16_t> frame) {
  const bool speech = IsSpeech(LevelDb(frame));
  if (in_speech_) {
    events_.sound(frame);
    length_ += kFrame;
    silence_ = speech ? Millis{0} : silence_ + kFrame;
    if (silence_ >= settings_.silence || length_ >= settings_.longest || IsComplete()) Finish();
    return;
  }
  lead_.insert(lead_.end(), frame.begin(), frame.end());
  speech_ = speech ? speech_ + kFrame : Millis{0};
  const auto keep = static_cast<std::size_t>((settings_.lead + speech_).count()) * kFramesPerMs;
  while (lead_.size() > keep) lead_.pop_front();
  if (speech_ < settings_.onset) return;
  in_speech_ = true;
  silence_ = Millis{0};
  const std::vector<std::int16_t> lead(lead_.begin(), lead_.end());
  lead_.clear();
  length_ = Millis(static_cast<std::int64_t>(lead.size() / kFramesPerMs));
  events_.begin();
  if (in_speech_) events_.sound(lead);
}

bool Endpointer::IsComplete() const {
  const Millis after = silence_ - settings_.complete;
  return settings_.complete.count() > 0 && events_.complete && after.count() >= 0 &&
         after % kAskEach == Millis{0} && events_.complete();
}

void Endpointer::Finish() {
  if (!in_speech_) return;
  Reset();
  events_.end();
}

void Endpointer::Reset() {
  in_speech_ = false;
  speech_ = silence_ = length_ = Millis{0};
  lead_.clear();
}

}  // namespace srm
