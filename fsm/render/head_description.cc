#include "fsm/render/head_description.h"

namespace fsm {

HeadDescription::HeadDescription(const Head& head, const HeadVertices& rest,
                                 const Appearance& appearance)
    : surface(head.shared_surface()) {
  const auto landmarks = FaceLandmarks::Find(head);
  if (landmarks && surface->uv.size() == rest.position.size()) {
    creases = WeighCreases(rest, *landmarks, appearance);
    skin = SkinPainting(surface, rest, *landmarks, appearance);
  }
  measures = HeadMeasures(head, rest, landmarks);
}

}  // namespace fsm
