#pragma once

#include <Eigen/Core>

#include "fsm/motion/inputs/motion_tables.h"
#include "vdm/train/corpus.h"
#include "vdm/train/dice.h"
#include "vdm/train/mouth_loss.h"

namespace vdm {

/// What a network is shown at once: the features of a sound and what the mouth does in it.
struct Lesson {
  Eigen::MatrixXf features;
  MouthTruth truth{};
};

/// The features of a whole sound, columns in time.
Eigen::MatrixXf FeaturesOf(std::span<const std::int16_t> samples, FeatureKind kind, float warp = 1);

/// A take as it was spoken, and distorted by chance.
Lesson PlainLesson(const Take& take, FeatureKind kind, const fsm::MotionTables& tables);
Lesson DistortedLesson(const Take& take, FeatureKind kind, const fsm::MotionTables& tables,
                       Dice dice);
/// Hides some of the features by zeros (Park and others, SpecAugment, 2019): up to two ranges of up
/// to 6 bands throughout, a moment of up to 70 ms for each second, and each phone with a chance of
/// a tenth. The levels stay. REQUIRES: kMel or kPhones.
void Mask(Eigen::MatrixXf& features, FeatureKind kind, Dice& dice);
/// A sound that is no speech: the mouth stays closed.
Lesson SilentLesson(FeatureKind kind, Dice dice);

}  // namespace vdm
