#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vdm {

/// Which phonemes look alike; tables/sounds.txt. A value, constant once it is read.
class SoundClasses {
 public:
  /// kBadValue "NAME:LINE: ..." for a class without phonemes, and for what stands there twice.
  static vm::Result<SoundClasses> Read(const std::string& name, std::string_view text);
  /// The table the program carries.
  static const SoundClasses& Built();

  const std::vector<std::string>& names() const { return names_; }
  std::size_t Of(std::string_view phoneme) const {
    const auto found = class_of_.find(phoneme);
    return found == class_of_.end() ? 0 : found->second;
  }

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::size_t, std::less<>> class_of_;
};

}  // namespace vdm
