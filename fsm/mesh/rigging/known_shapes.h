#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/mesh/imported_head.h"
#include "fsm/mesh/unrigged_head.h"

namespace fsm {

/// The state of the face that a shape shows at weight 1. `name`: in lower case, as
/// "mouthsmileleft".
struct ShapeMeaning {
  std::string name;
  FaceState state;
};

/// The shapes of a file whose names have a meaning.
struct KnownShapes {
  using Moves = std::vector<Displacement>;
  std::vector<std::string> names;                   ///< normalised (PlainShapeName)
  std::vector<FaceState> meanings;                  ///< by shape
  std::vector<Moves> moves;                         ///< by shape
  std::map<std::string, Moves, std::less<>> gazes;  ///< shapes that move the eyes: kGazeShapes
  std::vector<std::string> unused;                  ///< names, as in the file, of all others

  /// Returns the index of a shape; `names.size()` if it is not among them.
  std::size_t IndexOf(std::string_view name) const;
};

inline constexpr const char* kGazeShapes[] = {"vrmlookleft", "vrmlookright", "vrmlookup",
                                              "vrmlookdown"};

/// Finds the meanings of a file's shapes by their normalised names.
KnownShapes RecogniseShapes(const ImportedHead& file, const Similarity& to_ours,
                            const UnriggedHead& model, std::span<const ShapeMeaning> meanings);

}  // namespace fsm
