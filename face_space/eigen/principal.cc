#include "face_space/eigen/principal.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace facespace {

Principal FindPrincipal(const Eigen::Ref<const Eigen::MatrixXd>& samples, const Kept& kept) {
  const bool wide = samples.rows() <= samples.cols();
  const Eigen::MatrixXd products = wide ? Eigen::MatrixXd(samples * samples.transpose())
                                        : Eigen::MatrixXd(samples.transpose() * samples);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(products);
  Principal out;
  out.strengths = solver.eigenvalues().reverse().cwiseMax(0.0);
  out.total = out.strengths.sum();
  Eigen::Index most = 0;
  while (most < out.strengths.size() && out.strengths[most] > 1e-12 * out.total) ++most;
  Eigen::Index count = std::min<Eigen::Index>(kept.count, most);
  if (kept.count == 0) {
    double held = 0;
    while (count < most && held < kept.share * out.total) held += out.strengths[count++];
  }
  out.vectors.resize(samples.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const auto found = solver.eigenvectors().col(products.cols() - 1 - k);
    Eigen::VectorXd vector = wide ? Eigen::VectorXd(found) : Eigen::VectorXd(samples * found);
    vector.normalize();
    Eigen::Index at = 0;
    vector.cwiseAbs().maxCoeff(&at);
    out.vectors.col(k) = vector[at] < 0 ? -vector : vector;
  }
  return out;
}

}  // namespace facespace
