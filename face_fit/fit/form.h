#pragma once

#include <span>
#include <vector>

#include "face_fit/fit/fit.h"

namespace facefit {

/// In place of the network's points of closed inner lips: the line between the lips that the photo
/// shows. `now`: the base head's vertices with the photo's expression.
void AimAtMouthLine(const BaseHead& base, const FoundFace& face, const Pose& pose,
                    std::span<const glm::vec3> now, const fsm::Image& photo,
                    std::vector<LandmarkConstraint>& aims);

/// Fills irises and iris_size of a fit; without a photo irises lie where the eyes' outlines say.
void FindIrises(const BaseHead& base, const FoundFace& face, const fsm::Image* photo, Fit& fit);
/// Moves the outlines of eyes up or down where the irises show that the network misplaced them.
void CentreEyes(const BaseHead& base, const Fit& fit, std::vector<LandmarkConstraint>& aims);

/// The skin of the fitted head as fsm will show it in a state: its first vertices, which are those
/// of the base head.
std::vector<glm::vec3> SkinWith(const BaseHead& base, const Fit& fit, const fsm::FaceState& state);

/// Fills points, eyes and worn of a fit that has pose, expression and aims.
void WarpToLandmarks(const BaseHead& base, Fit& fit);

}  // namespace facefit
