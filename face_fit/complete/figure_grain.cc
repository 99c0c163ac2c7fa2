#include "face_fit/complete/figure_grain.h"

#include "face_fit/image/grain.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {

void AddGrainToFigure(const Mask& known, Mask amount, float pixels_per_mm, fsm::Image& image) {
  const auto& look = PhotoLook().grain;
  for (float& v : amount.values) v *= look.pixels_per_mm.Ramp(pixels_per_mm);
  AddGrain(known, amount, MmToPixels(look.coarsest_on_figure_mm, pixels_per_mm, 2), image);
}

}  // namespace facefit
