#include "vdm/recording/recording_reader.h"

#include <algorithm>
#include <numeric>

#include "fsm/motion/inputs/motion_tables.h"
#include "fsm/motion/speech/viseme_track.h"
#include "srm/align/speech_guesser.h"

namespace vdm {
namespace {

static_assert(kMouthParameters == fsm::kMouthParameters);

constexpr double kHopMs = 1000.0 * RecordedMouth::kHopSamples / srm::kSampleRateHz;
constexpr double kAroundMs = 100;

std::size_t HopOf(srm::Millis at) {
  return static_cast<std::size_t>(static_cast<double>(at.count()) / kHopMs);
}

/// The mean confidence of the words within kAroundMs, so that the mouth does not jump; each hop.
std::vector<float> Trusts(const std::vector<srm::HeardWord>& words, std::size_t count) {
  // Sums from the beginning on.
  std::vector<double> sums(count + 1, 0);
  for (std::size_t w = 0; w < words.size(); ++w) {
    // A word lasts until the next one: pauses are known as well as what stands around them.
    const bool last = w + 1 == words.size();
    const srm::Millis end = last ? words[w].end : words[w + 1].start;
    for (std::size_t k = HopOf(words[w].start); k < std::min(HopOf(end), count); ++k)
      sums[k + 1] = words[w].confidence;
  }
  std::partial_sum(sums.begin(), sums.end(), sums.begin());
  std::vector<float> trusts(count);
  const auto around = static_cast<std::size_t>(kAroundMs / kHopMs);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = k - std::min(k, around), over = std::min(k + around + 1, count);
    trusts[k] = static_cast<float>((sums[over] - sums[first]) / static_cast<double>(over - first));
  }
  return trusts;
}

class WordReader final : public RecordingReader {
 public:
  WordReader(std::unique_ptr<srm::SpeechGuesser> guesser, fsm::MotionTables tables)
      : guesser_(std::move(guesser)), tables_(std::move(tables)) {}

  RecordedMouth Read(const std::vector<std::int16_t>& samples) override {
    const srm::Alignment said = guesser_->Guess(samples);
    const fsm::VisemeTrack track(said.phonemes, tables_, fsm::LipStyle{});
    const auto trusts = Trusts(said.words, samples.size() / RecordedMouth::kHopSamples);
    RecordedMouth mouth;
    for (const float trust : trusts) {
      const fsm::MouthPose pose = track.At(static_cast<double>(mouth.instants.size()) * kHopMs);
      mouth.instants.push_back(
          {.frame = {.mouth = pose.mouth, .seal = pose.seal, .tongue = pose.tongue, .sounds = {}},
           .trust = trust});
    }
    for (const srm::HeardWord& word : said.words) {
      mouth.text += (mouth.text.empty() ? "" : " ") + word.text;
    }
    return mouth;
  }

 private:
  const std::unique_ptr<srm::SpeechGuesser> guesser_;
  const fsm::MotionTables tables_;
};

}  // namespace

vm::Result<std::unique_ptr<RecordingReader>> RecordingReader::Open() {
  auto tables = fsm::MotionTables::Load();
  if (!tables) return std::unexpected(tables.error());
  auto guesser = srm::SpeechGuesser::Open(srm::PocketsphinxOptions().model);
  if (!guesser) return std::unexpected(guesser.error());
  return std::make_unique<WordReader>(std::move(*guesser), std::move(*tables));
}

}  // namespace vdm
