#pragma once

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>

namespace facefit {

/// The numbers of tables/appearance.txt, which says what each means and in which unit.
struct Appearance {
  float facing_least, facing_least_aside, facing_soft, smile_folds_filled, smile_shade_evened,
      fold_half_width, fold_reach, crease_smooth, lip_inside, lip_soft, lip_reddened, squint_kept,
      lash_rim, iris_gain, iris_darkest, white_greyed, white_least, lid_shade, flash_pupil,
      skin_below_chin, sheet_rim, hair_depth, shoulder_depth, beyond_photo, shoulder_round,
      hole_face, hole_neck;
  glm::vec2 aside_across, aside_above_chin, shade_texels, roughness, colour_difference, hair_darker,
      hair_edge, light_gain, other_side_light, lip_beside, lip_inner, mouth_rim, beside_iris,
      flash_redder, flash_bluer, flash_bright, shoulder_fall, outline_doubt;
  glm::vec3 mouth_line_grey, mouth_line_colour, teeth_light, iris_unseen, white_unseen;
};

/// Reads such a table; `name` is for messages. Throws std::runtime_error "name:line: ..." for a
/// name that is unknown, missing or there twice, for other than its count of numbers, and for a
/// number beyond -1000..1000.
Appearance ReadAppearance(const std::string& name, std::string_view text);

/// The built-in one, read once; constant, thread: any.
const Appearance& BuiltInAppearance();

/// From 0 at the first number of a range to 1 at the second, smoothly; the first may be the larger.
inline float Ramp(glm::vec2 range, float v) { return glm::smoothstep(range.x, range.y, v); }

}  // namespace facefit
