#include "face_fit/make_face.h"

#include <utility>

#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/report.h"
#include "vm_protocol/core/or_throw.h"

namespace facefit {

vm::Result<FoundFace> ChooseFace(std::span<const FoundFace> faces, int number) {
  if (number < 1 || static_cast<std::size_t>(number) > faces.size()) {
    return vm::Fail(vm::Errc::kBadValue, "face " + std::to_string(number) + ": there are " +
                                             std::to_string(faces.size()) +
                                             ", counted from the largest");
  }
  return faces[static_cast<std::size_t>(number - 1)];
}

FrontPhoto LookAtFront(FaceNetworks& networks, const BaseHead& base, fsm::Image photo,
                       const FoundFace* face, int faces) {
  Cutout figure = CutOut(photo, SegmentPerson(networks, photo, face));
  Occlusion occlusion;
  if (face) occlusion = DetectOcclusion(networks, base, *face, photo);
  return {std::move(photo), std::move(figure), std::move(occlusion), faces};
}

MadeFace MakeFace(const BaseHead& base, const FrontPhoto& front, const FoundFace& face,
                  FaceNetworks* networks, const ExtraPhotos& extras, std::optional<bool> glasses,
                  const StepDone& done) {
  vm::OrThrow(CheckExtras(networks, extras));
  const auto tell = [&done](const char* step) {
    if (done) done(step);
  };
  MadeFace made;
  made.fit = FitFace(base, face, &front.photo);
  tell("head fitted");
  std::vector<ExtraView> views;
  for (const auto& extra : extras) {
    auto view = LookAtExtra(*networks, front.photo, *extra, made.fit);
    if (view) {
      views.push_back(std::move(*view));
    } else {
      made.left_out.push_back({extra->path, view.error().text});
    }
  }
  if (!views.empty()) tell("seen from the side, too");
  made.bake = BakeTexture(face, made.fit, front.photo, front.figure, views);
  if (glasses) made.bake.head.glasses = *glasses;
  tell("photo put on");
  made.report = Report(face, made.fit, front.photo, made.bake, front.faces, front.occlusion);
  return made;
}

}  // namespace facefit
