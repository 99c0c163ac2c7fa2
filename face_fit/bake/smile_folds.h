#pragma once

#include "face_fit/find/network/found_face.h"
#include "face_fit/image/raster.h"

namespace facefit {

/// Fills the folds that a smile makes from the wings of the nose past the corners of the mouth;
/// they would stay dark on a face at rest. Dark valleys narrower than the table's smile.folds take
/// the colour of what lies beside them. `share`: how much of them is filled, 0..1. Returns for each
/// pixel how much it was filled, 0..1, and so lost its grain.
Mask FillSmileFolds(const FoundFace& face, float share, float pixels_per_mm, fsm::Image& photo);

/// Restores the grain of filled folds on the skin's map from the cheek above and farther out.
/// `lost`: share of its grain that each texel lost, 0..1.
void GrainFromCheeks(const Mask& lost, fsm::Image& map);

}  // namespace facefit
