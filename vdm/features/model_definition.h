#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "vdm/features/model_file.h"

namespace vdm {

/// What the files of an acoustic model of CMU Sphinx share: mdef version 1, three states a phone.
struct ModelDefinition {
  std::vector<std::string> phones{};
  std::size_t triphones = 0;  ///< phones with and without neighbours
  std::size_t senones = 0;    ///< states that differ; the first are those of phones by themselves
  std::size_t sequences = 0;  ///< of three senones
  std::size_t tree_nodes = 0;
};

/// The head of mdef; what comes next in the file are the contexts.
vm::Result<ModelDefinition> ReadDefinition(ModelFile& mdef);

/// sendump: stream by stream, density by density a byte for each senone. Errors: kUnavailable,
/// kBadValue "FILE: ...".
vm::Result<std::string> ReadWeights(const std::string& folder, std::size_t densities,
                                    std::size_t senones);
/// The natural logarithm of such a weight; a byte is minus that to the base 1.0001, over 1024.
inline float WeightOf(unsigned char byte) {
  static const double step = 1024 * std::log(1.0001);
  return static_cast<float>(-step * byte);
}

}  // namespace vdm
