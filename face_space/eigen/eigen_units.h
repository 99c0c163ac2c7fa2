#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "face_space/eigen/head_motion.h"
#include "face_space/eigen/principal.h"
#include "vm_protocol/core/result.h"

namespace facespace {

/// An expression in a recording: from rest to rest.
struct Performance {
  std::size_t recording = 0;
  Eigen::Index first = 0, last = 0;  ///< frames
  Eigen::MatrixXd course;            ///< face vectors x kCourse: their coefficients over its time
  Eigen::VectorXd peak;              ///< the coefficients while it is at its most
};

/// What is missing of recordings, mm.
struct Missing {
  double rms = 0;    ///< root mean square of how far markers lie elsewhere
  double worst = 0;  ///< of one marker at one moment
};

/// Eigen-AUs (H. Yanagisawa, A. Maejima, T. Yotsukura, S. Morishima, Quantitative representation of
/// face expression using motion capture system, SIGGRAPH 2005 posters): a first principal component
/// analysis over the shapes of all frames gives face vectors (EFV); the coefficients of a whole
/// expression, frame after frame, are one vector, and a second analysis over those of all
/// expressions gives motion vectors (EMV). Expressions are brought to kCourse moments first, since
/// no two last equally long (the papers do not say how they did it).
struct EigenUnits {
  static constexpr Eigen::Index kCourse = 60;

  Principal face;    ///< 3 markers x count
  Principal motion;  ///< (kCourse * face.count()) x count; a column holds moment after moment
  Eigen::VectorXd least, most;  ///< coefficients of the face vectors in the recordings
  std::vector<Performance> performances;
  double moved_mm = 0;  ///< root mean square of all moves
  Missing by_face;      ///< with the face vectors alone, over all frames
  Missing by_motion;    ///< with the motion vectors, over the performances

  Eigen::MatrixXd Motion(Eigen::Index vector) const;  ///< face vectors x kCourse
};

/// Errors: kBadValue if there is no performance that begins and ends at rest.
vm::Result<EigenUnits> FindEigenUnits(const StillFaces& faces, const Kept& face,
                                      const Kept& motion);

/// One unit as recorded, by itself or in mixtures.
struct RecordedUnit {
  std::string name;
  Eigen::VectorXd moves;  ///< 3 markers, mm, at strength 1
  std::size_t in = 0;     ///< performances it is part of
};
/// Which units a recording shows, and how strongly.
struct Label {
  std::string unit;
  double strength = 1;
};
/// Takes units that were recorded in mixtures apart: those shapes, made of face vectors, whose sums
/// lie nearest to the peaks of all performances. `labels`: for each recording, none for those that
/// are not to count. Errors: kBadValue for units that are never without each other, as those
/// cannot be told apart, naming one.
vm::Result<std::vector<RecordedUnit>> TakeApart(const EigenUnits& units,
                                                const std::vector<std::vector<Label>>& labels);

}  // namespace facespace
