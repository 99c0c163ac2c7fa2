#include "vdm/train/forced_alignment.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

#include "vdm/features/phone_features.h"
#include "vdm/features/phone_model.h"
#include "vdm/net/sound_classes.h"

namespace vdm {
namespace {

constexpr int kFrameMs = 10;
constexpr int kShortestPhoneme = 3, kShortestPause = 6;  // frames
constexpr float kPauseCost = 4;
constexpr float kDurationCost = 4;  // of e times as long as usual
// A foreign sound is often taken for another one, but a vowel seldom for a consonant: so much of a
// class's likelihood comes from all of its kind.
constexpr float kOfKind = 0.2F;
constexpr float kImpossible = -1e30F;

enum class Kind { kPause, kConsonant, kVowel };

Kind KindOf(std::size_t sound) {
  static const std::size_t first_vowel = SoundClasses::Built().Of("aa");
  return sound == 0 ? Kind::kPause : sound < first_vowel ? Kind::kConsonant : Kind::kVowel;
}

/// The logarithm of how likely each class of sounds is: a row for each, a column for each frame.
Eigen::MatrixXf LikelySounds(const Eigen::MatrixXf& features) {
  const SoundClasses& classes = SoundClasses::Built();
  const auto& phones = (*InstalledPhoneModel())->phones();
  const Eigen::Index first = features.rows() - static_cast<Eigen::Index>(phones.size());
  const auto count = static_cast<Eigen::Index>(classes.names().size());
  // The phones of a vector are those of kLate frames before.
  const Eigen::Index late = PhoneFeatures::kLate,
                     frames = std::max<Eigen::Index>(features.cols() - late, 0);
  Eigen::MatrixXf likely = Eigen::MatrixXf::Zero(count, frames);
  for (std::size_t phone = 0; phone < phones.size(); ++phone) {
    std::string name = phones[phone];
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
    likely.row(static_cast<Eigen::Index>(classes.Of(name))) +=
        features.row(first + static_cast<Eigen::Index>(phone))
            .rightCols(frames)
            .unaryExpr(&PhoneFeatures::Likelihood);
  }
  for (Eigen::Index t = 0; t < likely.cols(); ++t) {
    std::array<float, 3> of_kind{};
    for (Eigen::Index c = 0; c < count; ++c) {
      of_kind[static_cast<std::size_t>(KindOf(static_cast<std::size_t>(c)))] += likely(c, t);
    }
    for (Eigen::Index c = 0; c < count; ++c) {
      const float kind = of_kind[static_cast<std::size_t>(KindOf(static_cast<std::size_t>(c)))];
      likely(c, t) = std::log((1 - kOfKind) * likely(c, t) + kOfKind * kind);
    }
  }
  return likely;
}

/// Where a part of the way ends: phonemes spoken and frames gone by, and how it came there.
struct Node {
  float score = kImpossible;
  int spoke = 0, paused = 0;  // frames of the last phoneme, and of the pause behind it
};

/// What speaking a phoneme for so long costs, where `usual` frames are expected.
float DurationCost(int frames, float usual) {
  const float ratio = std::log(static_cast<float>(frames) / usual);
  return kDurationCost * ratio * ratio;
}

/// The likeliest lengths: of each phoneme and the pause behind it, a node; that of the first pause
/// stands before them. Empty if there are too few frames.
std::vector<Node> LikeliestLengths(const Eigen::MatrixXf& likely, const vm::PhonemeList& phonemes,
                                   float speed) {
  const auto frames = static_cast<int>(likely.cols());
  // The sums of the likelihoods of all frames before one, so that a stretch is a difference.
  Eigen::MatrixXf before = Eigen::MatrixXf::Zero(likely.rows(), frames + 1);
  for (int t = 0; t < frames; ++t) before.col(t + 1) = before.col(t) + likely.col(t);
  std::vector<std::vector<Node>> nodes(phonemes.size() + 1,
                                       std::vector<Node>(static_cast<std::size_t>(frames) + 1));
  const auto pause_after = [&](std::vector<Node>& row, float cost) {
    // From the last frame on, so that no pause follows another.
    for (int end = frames; end >= kShortestPause; --end) {
      for (int length = kShortestPause; length <= end; ++length) {
        const Node& from = row[static_cast<std::size_t>(end - length)];
        const float score = from.score - cost + before(0, end) - before(0, end - length);
        if (score > row[static_cast<std::size_t>(end)].score) {
          row[static_cast<std::size_t>(end)] = {score, from.spoke, length};
        }
      }
    }
  };
  nodes[0][0].score = 0;
  pause_after(nodes[0], 0);
  for (std::size_t i = 0; i < phonemes.size(); ++i) {
    const auto sound = static_cast<Eigen::Index>(SoundClasses::Built().Of(phonemes[i].name));
    const float usual =
        std::max(speed * static_cast<float>(phonemes[i].duration.count()) / kFrameMs,
                 static_cast<float>(kShortestPhoneme));
    const int longest = std::max(static_cast<int>(4 * usual), 2 * kShortestPhoneme);
    for (int end = kShortestPhoneme; end <= frames; ++end) {
      Node& node = nodes[i + 1][static_cast<std::size_t>(end)];
      for (int length = kShortestPhoneme; length <= std::min(longest, end); ++length) {
        const float score = nodes[i][static_cast<std::size_t>(end - length)].score +
                            before(sound, end) - before(sound, end - length) -
                            DurationCost(length, usual);
        if (score > node.score) node = {score, length, 0};
      }
    }
    pause_after(nodes[i + 1], i + 1 < phonemes.size() ? kPauseCost : 0);
  }
  if (nodes.back().back().score == kImpossible) return {};
  std::vector<Node> way;
  int end = frames;
  for (std::size_t i = nodes.size(); i-- > 0;) {
    way.push_back(nodes[i][static_cast<std::size_t>(end)]);
    end -= way.back().spoke + way.back().paused;
  }
  std::ranges::reverse(way);
  return way;
}

ForcedAlignment Aligned(const Eigen::MatrixXf& likely, const vm::PhonemeList& phonemes,
                        float speed) {
  ForcedAlignment out;
  const auto add = [&](const std::string& name, int frames) {
    if (frames > 0) out.phonemes.push_back({name, std::chrono::milliseconds(kFrameMs * frames)});
  };
  Eigen::Index at = 0, spoken = 0;
  const std::vector<Node> way = LikeliestLengths(likely, phonemes, speed);
  for (std::size_t i = 0; i < way.size(); ++i) {
    if (i > 0) {
      const auto sound = static_cast<Eigen::Index>(SoundClasses::Built().Of(phonemes[i - 1].name));
      out.fit += static_cast<double>(likely.row(sound).segment(at, way[i].spoke).sum());
      spoken += way[i].spoke;
      add(phonemes[i - 1].name, way[i].spoke);
    }
    add("pau", way[i].paused);
    at += way[i].spoke + way[i].paused;
  }
  if (spoken > 0) out.fit /= static_cast<double>(spoken);
  return out;
}

float SpokenMs(const vm::PhonemeList& phonemes) {
  float ms = 0;
  for (const vm::Phoneme& phoneme : phonemes) {
    if (phoneme.name != "pau") ms += static_cast<float>(phoneme.duration.count());
  }
  return ms;
}

}  // namespace

ForcedAlignment AlignPhonemes(const Eigen::MatrixXf& features, const vm::PhonemeList& phonemes) {
  const Eigen::MatrixXf likely = LikelySounds(features);
  const ForcedAlignment first = Aligned(likely, phonemes, 1);
  if (first.phonemes.empty()) return first;
  return Aligned(likely, phonemes, SpokenMs(first.phonemes) / SpokenMs(phonemes));
}

}  // namespace vdm
