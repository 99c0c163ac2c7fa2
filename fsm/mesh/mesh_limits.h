#pragma once

#include <cstddef>

namespace fsm {

/// The largest head that is read from a file of any format.
inline constexpr std::size_t kMaxMeshVertices = 400000;
inline constexpr std::size_t kMaxMeshTriangles = 800000;
inline constexpr std::size_t kMaxMeshBytes = 200U << 20;  ///< per file

}  // namespace fsm
