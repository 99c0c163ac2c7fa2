#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

/// How likely each phone of English makes a frame of sound, from the acoustic model that Debian's
/// pocketsphinx-en-us installs: mixtures of Gaussians learned from many people (CMU Sphinx; the
/// formats: mdef version 1, means and variances "s3", sendump). Only the states of phones without
/// context are read: three for each, a codebook of 128 Gaussians for each of three streams
/// (cepstra, their first and second differences). A mixture counts as its likeliest part.
/// A value, constant once read. Thread: const calls may run at once.
class PhoneModel {
 public:
  static constexpr std::size_t kStreams = 3, kStream = 13, kStates = 3;
  static constexpr std::size_t kFeatures = kStreams * kStream;
  /// From a folder with mdef, means, variances and sendump. Errors: kUnavailable (a file is
  /// missing), kBadValue "FILE: ..." (damaged, or a model of another kind).
  static vm::Result<std::shared_ptr<const PhoneModel>> Read(const std::string& folder);

  /// Names as in the model (AA, ..., SIL, +NSN+), in its order.
  const std::vector<std::string>& phones() const { return phones_; }
  /// The natural logarithm of each state's likelihood, phone by phone: a column of kStates x phones
  /// for each column of `features`. What a column gives does not depend on the others; together
  /// they are faster. REQUIRES: kFeatures rows.
  Eigen::MatrixXf Score(const Eigen::MatrixXf& features) const;
  /// How many Gaussians a codebook has in each stream.
  std::size_t densities() const { return blocks_a_codebook_ * kBlock; }
  /// The natural logarithm of each Gaussian of a phone's codebook at kFeatures numbers, stream by
  /// stream. REQUIRES: room for kStreams x densities().
  void Densities(std::size_t phone, const float* features, std::span<float> densities) const;

 private:
  static constexpr std::size_t kBlock = 8;  // Gaussians that are computed together
  using Lane = Eigen::Array<float, kBlock, 1>;
  /// kBlock Gaussians of one stream: log N(x) = constant + sum of (square x^2 + linear x).
  struct Block {
    Lane constant;
    std::array<Lane, kStream> square, linear;
    std::array<Lane, kStates> weights;  // logarithms of the parts in each state's mixture
  };
  using Best = std::array<Lane, kStates>;
  void ScoreCodebook(std::size_t phone, std::size_t stream, const Eigen::MatrixXf& features,
                     const std::vector<Eigen::Index>& columns, Eigen::MatrixXf& states,
                     std::vector<Best>& best) const;
  std::vector<std::string> phones_;
  std::vector<Block> blocks_;  // phone by phone, stream by stream
  std::size_t blocks_a_codebook_ = 0;
};

/// Where Debian's pocketsphinx-en-us lies.
inline constexpr const char* kPhoneModelFolder = "/usr/share/pocketsphinx/model/en-us/en-us";
/// That model, read when first asked for.
const vm::Result<std::shared_ptr<const PhoneModel>>& InstalledPhoneModel();

}  // namespace vdm
