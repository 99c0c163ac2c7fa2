#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "film_dub/paint/placing.h"
#include "fsm/image/image.h"

namespace filmdub {

/// A face as drawn, to be laid onto a picture of the film.
struct DrawnMouth {
  const fsm::Image* picture = nullptr;  ///< on nothing; outlives the painting
  Placing placing;                      ///< from its pixels to the film's
  std::vector<glm::vec2> points;        ///< the network's, in its pixels
  double grain = 0;                     ///< GrainBetween of the film
  std::uint64_t seed = 1;               ///< of the grain, another one for each picture
};

/// Lays mouth and chin of a drawn face over those of a picture. Its colours are brought to those of
/// the film by the quotient of both around the mouth, smoothed, for each colour, and its grain,
/// too; its edge fades out inside the skin. `seen`: where the picture shows the network's points.
/// `share`: 1 = all of it, 0 = nothing. It reaches from below the nose over both cheeks to a little
/// below the chin; where the new chin is higher or lower than the old one, the neck below is
/// stretched or pressed together. No pixel elsewhere is touched. Pure; thread: any.
void PaintMouth(fsm::Image& picture, std::span<const glm::vec2> seen, const DrawnMouth& drawn,
                float share);

}  // namespace filmdub
