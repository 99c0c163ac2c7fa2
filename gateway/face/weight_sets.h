#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gateway/face/mouth_numbers.h"
#include "gateway/face/weight_sums.h"

namespace gateway {

/// One way to tell a mouth by weights from 0 to 1, beside names in a fixed order: visemes by how
/// likely each is (their sum is 1), or blend shapes by sums of the mouth's numbers. A plain value.
class WeightSet {
 public:
  const std::string& name() const { return name_; }
  const std::vector<std::string>& names() const { return names_; }
  /// Of visemes, one is what the mouth shows most.
  bool visemes() const { return !of_sound_.empty(); }
  std::vector<float> Of(const vdm::MouthFrame& frame) const;
  /// The viseme of a class of sounds. REQUIRES: visemes().
  std::size_t OfSound(std::size_t sound) const { return of_sound_[sound]; }

 private:
  friend class WeightSets;
  std::string name_;
  std::vector<std::string> names_;
  std::vector<std::size_t> of_sound_;  // beside vdm::SoundClasses
  WeightSums sums_;                    // of blend shapes
};

/// The sets a client may ask for: visemes22, oculus15, arkit52. Constant.
class WeightSets {
 public:
  /// Tables as gateway/tables/ has them. kBadValue "NAME:LINE: ...".
  static vm::Result<WeightSets> Read(std::string_view visemes, std::string_view arkit);
  /// The tables the program carries.
  static const WeightSets& Built();

  /// kBadValue names those there are.
  vm::Result<const WeightSet*> Find(std::string_view name) const;

 private:
  vm::Result<void> ReadVisemes(std::string_view text);
  vm::Result<void> ReadBlendShapes(std::string_view text);
  std::vector<WeightSet> sets_;
};

}  // namespace gateway
