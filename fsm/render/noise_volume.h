#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fsm {

/// Cells along each side of the noise volume.
inline constexpr int kNoiseCells = 32;

/// A tileable volume of noise, kNoiseCells^3 RGBA bytes, x fastest: the value in alpha and half its
/// difference along x, y and z in red, green and blue, both offset to 128. Always the same bytes.
std::vector<std::uint8_t> MakeNoiseVolume();

/// The volume's value at a place in cells, between the cells' values, -0.5..0.5.
float NoiseAt(const glm::vec3& cells);

}  // namespace fsm
