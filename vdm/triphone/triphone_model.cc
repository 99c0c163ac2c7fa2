#include "vdm/triphone/triphone_model.h"

#include <algorithm>

#include "vdm/net/sound_classes.h"

namespace vdm {
namespace {

constexpr double kMostMs = 600'000;

const std::string& PhonemeAt(const Triphone& triphone, Side side) {
  if (side == Side::kLeft) return triphone.left;
  return side == Side::kCentre ? triphone.centre : triphone.right;
}

}  // namespace

const Expectation& ExpectationOf(const TriphoneModel& model, const TriphoneState& state) {
  const std::vector<TreeNode>& tree = model.trees[state.state];
  const TreeNode* node = &tree.front();
  while (node->set >= 0) {
    const PhonemeSet& set = model.sets[static_cast<std::size_t>(node->set)];
    node =
        &tree[set.phonemes.contains(PhonemeAt(state.triphone, node->side)) ? node->yes : node->no];
  }
  return node->expectation;
}

vm::Result<std::vector<MouthFrame>> MouthOf(const TriphoneModel& model,
                                            const vm::PhonemeList& phonemes) {
  if (static_cast<double>(vm::TotalDuration(phonemes).count()) > kMostMs) {
    return vm::Fail(vm::Errc::kLimit, "phonemes of more than ten minutes");
  }
  const SoundClasses& classes = SoundClasses::Built();
  std::vector<const Expectation*> expected;
  std::vector<std::size_t> sounds;
  for (const TriphoneState& state : StatesOf(phonemes, model.step_ms)) {
    expected.resize(state.end, &ExpectationOf(model, state));
    sounds.resize(state.end, classes.Of(state.triphone.centre));
  }
  const Eigen::MatrixXf track = LikeliestTrack(expected).cast<float>();
  std::vector<MouthFrame> frames(expected.size());
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const auto column = track.col(static_cast<Eigen::Index>(t));
    std::copy_n(column.data(), kMouthParameters, frames[t].mouth.begin());
    frames[t].tongue = std::clamp(column[kMouthParameters], 0.0F, 1.0F);
    frames[t].seal = std::clamp(column[kShapeNumbers], 0.0F, 1.0F);
    frames[t].sounds.resize(classes.names().size());
    frames[t].sounds[sounds[t]] = 1;
  }
  return frames;
}

}  // namespace vdm
