#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

/// Linear discriminant functions (R. A. Fisher, The use of multiple measurements in taxonomic
/// problems, 1936): of each class a constant and a weight for each feature. The softmax of the
/// functions is how likely each class is, where the features of each are spread normally and alike.
/// A plain value.
struct Discriminant {
  std::vector<std::string> features{};
  struct Class {
    std::string name{};
    double constant = 0;
    Eigen::VectorXd weights{};
  };
  std::vector<Class> classes{};
  /// Features beyond so much, on either side of zero, count as so much.
  Eigen::VectorXd most{};

  /// How likely each class is; sum 1. REQUIRES: as many numbers as features.
  std::vector<double> Likelihoods(const Eigen::VectorXd& features) const;
};

/// One thing that was measured, and the class it belongs to.
struct Example {
  std::string label;
  Eigen::VectorXd features;
};
/// The functions that tell the classes of the examples apart, each class as likely as the others,
/// with the covariance that they have in common. Classes come in the order of `classes`. Errors:
/// kBadValue for a class with fewer than three examples, or a label that is not of `classes`.
vm::Result<Discriminant> LearnDiscriminant(const std::vector<std::string>& features,
                                           const std::vector<std::string>& classes,
                                           const std::vector<Example>& examples);

/// The text of discriminant functions. Lines: words between blanks, `#` begins a comment.
///
///   features NAME...
///   most NUMBER...
///   class NAME CONSTANT WEIGHT...    at least two
///
/// Limits: 64 KiB, 16 features, 16 classes. Errors: kBadValue "NAME:LINE: ...".
vm::Result<Discriminant> ParseDiscriminant(const std::string& name, std::string_view text);
std::string FormatDiscriminant(const Discriminant& discriminant);

}  // namespace vdm
