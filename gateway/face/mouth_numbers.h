#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "vdm/net/mouth_frame.h"

namespace gateway {

/// What tables of weights may name of a mouth, by their places in kMouthNumbers: the mouth
/// parameters (mm on a mouth 50 mm wide, jaw in degrees), what opens the lips only as far as they
/// are not sealed; seal and tongue; the jaw's degrees as far as the lips are sealed over it.
inline constexpr std::array<std::string_view, vdm::kMouthParameters + 3> kMouthNumbers{
    "upper_outer_y",    "upper_outer_z",    "upper_inner_y",
    "upper_inner_z",    "lower_inner_y",    "lower_inner_z",
    "lower_outer_y",    "lower_outer_z",    "corner_x",
    "corner_y",         "corner_z",         "jaw",
    "jaw_thrust",       "upper_outer_full", "upper_inner_full",
    "lower_outer_full", "lower_inner_full", "seal",
    "tongue",           "sealed_jaw"};
inline constexpr std::size_t kUpperInnerY = 2, kLowerInnerY = 4, kUpperOuterZ = 1, kCornerX = 8,
                             kJaw = 11;

std::optional<std::size_t> MouthNumberOf(std::string_view word);
std::array<float, kMouthNumbers.size()> MouthNumbers(
    const std::array<float, vdm::kMouthParameters>& mouth, float seal, float tongue);

}  // namespace gateway
