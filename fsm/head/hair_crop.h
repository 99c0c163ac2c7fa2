#pragma once

#include <vector>

#include "fsm/head/features.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/paint.h"

namespace fsm {

struct CropStyle {
  float side_mm, top_mm;  ///< of the shell over the skin
  int locks;
  float lock_mm;   ///< length of a lock
  float lift_mm;   ///< of its tip over the shell
  float wave_mm;   ///< sideways swing of a lock
  float front_up;  ///< how far locks over the forehead stand up, 0..1
  float recede;    ///< degrees the hairline is drawn back at the temples
  float curl = 0;  ///< 0: hairs lie along the head; 1: tight curls, which stand off it
};
/// Single hairs on the skin beside the edge of the hair; see LongHairline.
std::vector<SkinHair> CroppedHairline(const CropStyle& style, const Features& features,
                                      const Palette& palette, HeadMesh& mesh);
/// Short hair all round.
void BuildCroppedHair(const CropStyle& style, const Features& features, const Palette& palette,
                      HeadMesh& mesh);

}  // namespace fsm
