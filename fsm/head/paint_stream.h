#pragma once

#include "fsm/base/random.h"

namespace fsm {

/// The streams of noise by which hairs, teeth and irises differ, each for one property. Two streams
/// with the same number give the same noise to the same seed; the numbers stay, as all pictures
/// depend on them.
enum class PaintStream : int {
  // Locks of long hair, and single hairs that stand off, whose seeds begin beyond those of locks.
  kLockPlace = 1,
  kLockFrom = 2,
  kLockTo = 3,
  kLockLift = 4,
  kLockWidth = 6,
  kFlyawayPlace = 1,
  kFlyawayFrom = 2,
  kFlyawayLength = 3,
  kFlyawayDrift = 4,
  kFlyawayOff = 5,
  kPointed = 17,
  kLockLean = 18,
  // Cropped hair.
  kCropLockX = 31,
  kCropLockZ = 32,
  kCropLockLength = 33,
  kCropLockLift = 34,
  kCropLockWidth = 35,
  kCropEdge = 61,
  kCropBelow = 62,  // and those that follow, one for each row
  // All hair of the head.
  kStrandColour = 3,
  kStreakColour = 11,
  kStreakAlong = 40,  // and those that follow, one for each row
  kLockTileAlong = 71,
  kLockTileAcross = 72,
  // Single hairs at its edge.
  kHairlineLength = 81,
  kHairlineWay = 82,
  kHairlineBend = 83,
  kHairlineCover = 84,
  kHairlineWidth = 85,
  kHairlinePlace = 91,
  kHairlineOff = 92,
  // Lashes.
  kPhotoLashDark = 4,
  kLashLean = 5,
  kPhotoLashLean = 6,
  kLashLength = 9,
  kLashPlace = 71,
  // Brows.
  kBrowAlong = 21,
  kBrowRow = 22,
  kBrowLean = 23,
  kBrowLength = 24,
  kBrowTint = 25,
  kBrowThin = 26,
  kBrowWidth = 27,
  // Stubble.
  kStubbleAside = 41,
  kStubbleHeight = 42,
  kStubbleThin = 43,
  kStubbleLength = 44,
  kStubbleLean = 45,
  kStubbleCover = 46,
  // Teeth, and the rays of the iris.
  kToothLength = 0,  // plus or minus one, by the jaw
  kToothShade = 7,
  kIrisFibre = 0  // and those that follow, by the ring
};

/// Returns the noise of a hair, a strand or a tooth, in -1..1; `row`: added to the stream's number.
inline float NoiseAt(int seed, PaintStream stream, int row = 0) {
  return NoiseAt(seed, static_cast<int>(stream) + row);
}

}  // namespace fsm
