#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace facespace {

/// Directions of the greatest variance.
struct Principal {
  Eigen::MatrixXd vectors;    ///< a column each, of unit length, the strongest first
  Eigen::VectorXd strengths;  ///< sum of squares along each of them, those left out included
  double total = 0;           ///< sum of squares of everything

  Eigen::Index count() const { return vectors.cols(); }
  double Share(Eigen::Index vector) const { return strengths[vector] / total; }
};

/// How many vectors are kept.
struct Kept {
  double share = 0.99;  ///< as many as hold this part of the variance together
  int count = 0;        ///< not 0: so many, whatever they hold
};

/// Principal components of the columns of `samples`, about zero and not about their mean: zero is
/// the face at rest, from which everything moves. The sign of a vector is such that its largest
/// number is positive. Time: the cube of the smaller of rows and columns.
/// REQUIRES: not all samples are zero.
Principal FindPrincipal(const Eigen::Ref<const Eigen::MatrixXd>& samples, const Kept& kept);

}  // namespace facespace
