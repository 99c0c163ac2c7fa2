#pragma once

#include <array>
#include <map>
#include <vector>

#include "vdm/train/mouth_loss.h"
#include "vdm/triphone/triphone_model.h"
#include "vm_protocol/core/phonemes.h"

namespace vdm {

/// The questions the program carries; tables/questions.txt.
const std::vector<PhonemeSet>& BuiltPhonemeSets();

/// Instants of one kind added up: how many, and of each number and its windows the sum and the sum
/// of squares.
struct Statistics {
  double count = 0;
  Eigen::VectorXd sum{}, squares{};

  void Add(const Statistics& other);
};

/// When a tree stops growing.
struct TreePlan {
  std::size_t leaves = 400;    ///< of each state, at most
  double least_instants = 20;  ///< in a leaf
  /// What a leaf more must explain, beside half the logarithm of all instants for each of its
  /// parameters (minimum description length: Shinoda and Watanabe, 2000).
  double cost = 1;
  /// No variance is smaller than this part of that of all instants.
  double variance_floor = 0.001;
};

/// Learns the mouth of triphones from tracks with known phonemes: adds up what the mouth does in
/// each state of each triphone, and grows a tree for each state, always where one more question
/// explains most. Deterministic.
class TriphoneTraining {
 public:
  explicit TriphoneTraining(double step_ms) : step_ms_(step_ms) {}

  /// `truth` begins with the phonemes, step_ms apart; what is longer of the two is left out.
  void Add(const vm::PhonemeList& phonemes, const MouthTruth& truth);
  /// Error: kBadValue if nothing was added for some state.
  vm::Result<TriphoneModel> Grow(const std::vector<PhonemeSet>& sets, const TreePlan& plan) const;

 private:
  const double step_ms_;
  std::array<std::map<Triphone, Statistics>, kStates> seen_;
};

}  // namespace vdm
