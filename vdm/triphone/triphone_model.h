#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "vdm/net/mouth_frame.h"
#include "vdm/triphone/questions.h"
#include "vdm/triphone/trajectory.h"
#include "vdm/triphone/triphone_states.h"
#include "vm_protocol/core/result.h"

namespace vdm {

/// The numbers of a mouth that are learned: the shape (MouthNet's) and the sealing of the lips.
inline constexpr std::size_t kTrackNumbers = kShapeNumbers + 1;

enum class Side { kLeft, kCentre, kRight };
inline constexpr std::array<const char*, 3> kSideNames = {"left", "centre", "right"};

/// A place in a decision tree: a question of a phoneme of the triphone, and where to go on; or,
/// without a question, a leaf.
struct TreeNode {
  Side side = Side::kCentre;
  int set = -1;  ///< index into TriphoneModel::sets; -1: a leaf
  std::size_t yes = 0, no = 0;
  Expectation expectation{};  ///< of a leaf: kWindows * kTrackNumbers
};

/// How a mouth moves through the states of triphones: a decision tree for each of the three states
/// (Odell, "The use of context in large vocabulary speech recognition", 1995), whose leaves say
/// what is expected of the mouth. A plain value.
struct TriphoneModel {
  double step_ms = 10;
  std::vector<PhonemeSet> sets{};
  std::array<std::vector<TreeNode>, kStates> trees{};  ///< the first node is the root
};

/// REQUIRES: a tree that ends.
const Expectation& ExpectationOf(const TriphoneModel& model, const TriphoneState& state);

/// The text of a model. Lines: words between blanks, `#` begins a comment.
///
///   step MS
///   set NAME PHONEME...
///   state beginning|middle|end     its tree: a node, at `ask` followed by the tree of yes and that
///   of no ask left|centre|right SET leaf means NUMBER x 57              values, slopes, bends of
///   shape and seal variances NUMBER x 57
///
/// Limits: 8 MiB, 256 sets, 4096 nodes a state. Errors: kBadValue "NAME:LINE: ..." saying what was
/// found and expected.
vm::Result<TriphoneModel> ParseTriphones(const std::string& name, std::string_view text);
/// The reverse; four digits a number.
std::string FormatTriphones(const TriphoneModel& model);

/// The mouth of spoken phonemes, a frame each step_ms. Error: kLimit for more than ten minutes.
vm::Result<std::vector<MouthFrame>> MouthOf(const TriphoneModel& model,
                                            const vm::PhonemeList& phonemes);

}  // namespace vdm
