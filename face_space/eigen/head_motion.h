#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "face_space/record/recording.h"
#include "vm_protocol/core/result.h"

namespace facespace {

/// How the face moves in a recording, without the head.
struct FaceMoves {
  std::string name;
  std::vector<double> ms;
  Eigen::MatrixXd moves;  ///< 3 markers x frames: mm from rest, in the frame of FaceAtRest
};

/// The face at rest: where the markers of the first recording lie at its beginning.
struct FaceAtRest {
  std::vector<std::string> markers;
  Eigen::Matrix3Xd places;          ///< mm
  std::vector<Eigen::Index> still;  ///< markers by which the head's motion was found
};

struct RestSettings {
  double rest_ms = 200;            ///< at its beginning every recording is at rest so long
  std::vector<std::string> still;  ///< markers that the face does not move; none: they are found
};

/// A turn and a shift.
struct RigidMove {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};
/// What takes `from` nearest to `to`, by least squares over the columns `used`: Kabsch, A solution
/// for the best rotation to relate two sets of vectors, 1976, by a singular value decomposition.
/// REQUIRES: three columns or more that are not all on a line.
RigidMove FitRigid(const Eigen::Ref<const Eigen::Matrix3Xd>& from,
                   const Eigen::Ref<const Eigen::Matrix3Xd>& to,
                   const std::vector<Eigen::Index>& used);

struct StillFaces {
  FaceAtRest rest;
  std::vector<FaceMoves> faces;  ///< one for each recording
};
/// Takes the head's motion out of recordings of one face. Each frame is brought onto the rest by
/// the markers that move least in all recordings (a third, found in four rounds), or by those that
/// are named. REQUIRES: one recording or more, with the same markers. Errors: kBadValue: an unknown
/// name, fewer than three still markers, still markers on a line, nothing that moves (less than
/// 0.02 mm).
vm::Result<StillFaces> RemoveHeadMotion(const std::vector<Recording>& recordings,
                                        const RestSettings& settings);

}  // namespace facespace
