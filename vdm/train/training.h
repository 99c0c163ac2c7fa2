#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fsm/motion/inputs/motion_tables.h"
#include "vdm/train/adam.h"
#include "vdm/train/corpus.h"
#include "vdm/train/dice.h"
#include "vdm/train/lesson.h"
#include "vdm/train/mouth_loss.h"
#include "vdm/train/score.h"

namespace vdm {

struct TrainingPlan {
  FeatureKind features = FeatureKind::kMel;
  std::size_t width = 128;  ///< of the hidden layers (not kCepstra)
  bool long_past = false;   ///< hears 80 ms more before an instant (not kCepstra)
  std::size_t epochs = 24;
  std::uint64_t seed = 1;
  double disturbance = 0.15;  ///< of hidden units, see BackPropagation::Disturb (not kCepstra)
  double masking = 0.4;       ///< share of the lessons that are masked, see Mask (not kCepstra)
  /// Networks of the same features and sounds: the mean of their outputs is learned beside the
  /// truth (Hinton and others, Distilling the knowledge in a neural network, 2015).
  std::vector<MouthNet> teachers{};
  std::optional<MouthNet> from{};  ///< begins with it, not with a StartingNet
  double rate = 2e-3;  ///< the highest step; it rises at the start and falls to almost nothing
};

/// The layers for a kind of features: for kMel five layers that see 180 ms and more back and 50 ms
/// ahead (with half a window, 60 ms of the sound after the instant); for kCepstra the papers' three
/// layers of 20 units over one frame. Weights by chance (He and others, 2015).
MouthNet StartingNet(const TrainingPlan& plan, const std::vector<Take>& takes,
                     const fsm::MotionTables& tables);

/// The course of a training: what is learned and where it stands. The same plan and takes give the
/// same bits on the same machine and compiler, also when the course was kept and resumed: the work
/// of a step is always divided among kLanes threads in the same way.
class Training {
 public:
  static constexpr std::size_t kLanes = 2;
  /// `takes` and `tables` outlive it. REQUIRES: at least one take.
  Training(const TrainingPlan& plan, const std::vector<Take>& takes,
           const fsm::MotionTables& tables);

  bool done() const { return epoch_ >= plan_.epochs; }
  std::size_t epoch() const { return epoch_; }
  const MouthNet& net() const { return net_; }
  struct Report {
    MouthLoss loss;  ///< the mean over the epoch's instants
    double seconds_of_sound = 0;
  };
  /// Goes once through all takes. `progress` is told how much of it is done, 0 .. 1.
  Report Epoch(const std::function<void(double)>& progress);

  /// Keeps and brings back all that a course consists of. Errors: kUnavailable, kBadValue (another
  /// plan's, damaged).
  vm::Result<void> Save(const std::string& path) const;
  vm::Result<void> Load(const std::string& path);

 private:
  struct Lane;
  /// The truth of a lesson, and what the teachers say of it.
  Eigen::MatrixXf Wanted(const Lesson& lesson) const;
  void Learn(const std::vector<std::size_t>& items, Dice dice, Lane& lane) const;
  double RateAt(long step, long steps) const;

  const TrainingPlan plan_;
  const std::vector<Take>& takes_;
  const fsm::MotionTables& tables_;
  MouthNet net_;
  Adam adam_;
  std::size_t epoch_ = 0;
};

/// How well a network follows takes as they were spoken, by the opening of FrameOf.
Score ScoreOf(const MouthNet& net, const std::vector<Take>& takes, const fsm::MotionTables& tables);

}  // namespace vdm
