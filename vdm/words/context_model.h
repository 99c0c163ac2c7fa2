#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vdm/features/phone_model.h"

namespace vdm {

/// The states of phones between their neighbours (triphones) in the acoustic model of PhoneModel:
/// other mixtures of the same Gaussians (mdef, sendump). A value, constant once read. Thread: const
/// calls may run at once.
class ContextModel {
 public:
  /// Where in a word a phone is; numbers of mdef.
  enum class Place : std::uint8_t { kInside = 0, kBegin = 1, kEnd = 2, kSingle = 3 };
  using Phone = std::uint8_t;      ///< index of PhoneModel::phones()
  using Sequence = std::uint16_t;  ///< of three states

  /// From the folder `phones` was read from. Errors: kUnavailable, kBadValue "FILE: ...".
  static vm::Result<std::shared_ptr<const ContextModel>> Read(
      const std::string& folder, std::shared_ptr<const PhoneModel> phones);

  const PhoneModel& phones() const { return *phones_; }
  /// The states of a phone between two others, or those nearest to them: as inside a word, or by
  /// itself. Noises count as silence beside a phone. REQUIRES: phones of the model.
  Sequence SequenceOf(Phone phone, Phone left, Phone right, Place place) const;
  Sequence SequenceOf(Phone phone) const { return triphones_[phone].sequence; }

 private:
  friend class ContextScorer;
  struct Triphone {
    Sequence sequence = 0;
    Phone base = 0;
  };
  /// A level of the tree by place, phone, left and right: `count` more below, or a triphone, or
  /// kNothing.
  static constexpr std::uint32_t kNothing = 0xFFFFFFFF;
  struct TreeNode {
    std::int16_t context = 0;
    std::uint16_t count = 0;
    std::uint32_t below = 0;
  };
  vm::Result<void> ReadContexts(const std::string& folder);
  vm::Result<void> ReadMixtures(const std::string& folder);
  /// Null if there is none.
  const Triphone* Find(Phone phone, Phone left, Phone right, Place place) const;

  std::shared_ptr<const PhoneModel> phones_;
  std::vector<bool> noise_;  // by phone
  Phone silence_ = 0;
  std::vector<TreeNode> tree_;
  std::size_t roots_ = 0;
  std::vector<Triphone> triphones_;
  std::vector<std::array<std::uint16_t, PhoneModel::kStates>> sequences_;  // senones
  // Senones are counted by phone: that of each, and the first of each phone (and one behind).
  std::vector<Phone> bases_;
  std::vector<std::size_t> first_;
  std::vector<float> weights_;  // phone by phone, stream by stream, density by density, by senone
};

/// How likely one frame is in the states asked for. Lifetime: the model outlives it. Thread: none
/// of its own; one instance, one thread.
class ContextScorer {
 public:
  explicit ContextScorer(const ContextModel& model);
  /// A frame of PhoneModel::kFeatures numbers, which it keeps looking at.
  void Begin(const float* features);
  /// The natural logarithm of the likelihood of a state, by the kTop nearest Gaussians a stream.
  float Of(ContextModel::Sequence sequence, std::size_t state);

 private:
  static constexpr std::size_t kTop = 4;
  struct Nearest {
    std::size_t density = 0;
    float likely = 0;
  };
  void FindNearest(std::span<const float> likely);
  void ScorePhone(std::size_t phone);

  const ContextModel& model_;
  const float* features_ = nullptr;
  std::uint32_t frame_ = 0;
  std::vector<std::uint32_t> phone_frame_;  // scored last
  Eigen::ArrayXf scores_, mixture_;         // by senone
  std::vector<float> densities_;
  std::array<Nearest, kTop> nearest_{};
};

}  // namespace vdm
