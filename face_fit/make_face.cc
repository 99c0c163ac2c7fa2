#include "face_fit/make_face.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/find/face/close_up.h"
#include "face_fit/find/face/cut_off.h"
#include "face_fit/find/face/glasses.h"
#include "face_fit/find/face/upright.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/photo.h"
#include "face_fit/report.h"

namespace facefit {
namespace {

// Each of these finds a face as one FaceChoice asks for, and sets FrontPhoto::photo, face_count
// and, if there is one, face; the first sets orientation, too.

vm::Result<FrontPhoto> FindByNumber(FaceNetworks& networks, fsm::Image photo, int number) {
  UprightPhoto upright = SetUpright(networks, std::move(photo));
  FrontPhoto front{.photo = std::move(upright.image),
                   .face_count = static_cast<int>(upright.faces.size()),
                   .orientation = upright.orientation};
  if (upright.faces.empty()) return front;
  auto face = ChooseFace(upright.faces, number);
  if (!face) return std::unexpected(face.error());
  front.face = FrontFace{std::move(*face)};
  return front;
}

FrontPhoto FindNearest(FaceNetworks& networks, fsm::Image photo, glm::vec2 nose) {
  const auto faces = FindFaces(networks, photo);
  FrontPhoto front{.photo = std::move(photo), .face_count = static_cast<int>(faces.size())};
  const auto nearest = std::ranges::min_element(faces, {}, [nose](const FoundFace& face) {
    return glm::distance(face.PixelOf(point::kNoseTip), nose);
  });
  if (nearest != faces.end()) front.face = FrontFace{*nearest};
  return front;
}

vm::Result<FrontPhoto> TakeFromHand(const ObservedHead& base, fsm::Image photo,
                                    const HandPoints& points) {
  if (auto within = CheckWithin(points, photo.width, photo.height); !within) {
    return std::unexpected(within.error());
  }
  return FrontPhoto{
      .photo = std::move(photo), .face = FrontFace{FaceFromHand(base, points)}, .face_count = 1};
}

float LongerSide(const fsm::Image& photo) {
  return static_cast<float>(std::max(photo.width, photo.height));
}

}  // namespace

vm::Result<FoundFace> ChooseFace(std::span<const FoundFace> faces, int number) {
  if (number < 1 || static_cast<std::size_t>(number) > faces.size()) {
    return vm::Fail(vm::Errc::kBadValue, "face " + std::to_string(number) + ": there are " +
                                             std::to_string(faces.size()) +
                                             ", counted from the largest");
  }
  return faces[static_cast<std::size_t>(number - 1)];
}

vm::Result<FrontPhoto> PrepareFront(FaceNetworks& networks, const ObservedHead& base,
                                    fsm::Image photo, const FaceChoice& choice, PhotoExtent extent,
                                    const StepDone& done) {
  fsm::Image working = extent == PhotoExtent::kWhole ? photo : ScaledToFit(photo, kWorkingSize);
  const float scale = LongerSide(working) / LongerSide(photo);
  auto found = [&]() -> vm::Result<FrontPhoto> {
    if (const auto* by_number = std::get_if<FaceNumber>(&choice)) {
      return FindByNumber(networks, std::move(working), by_number->number);
    }
    if (const auto* near = std::get_if<FaceNear>(&choice)) {
      return FindNearest(networks, std::move(working), scale * near->nose);
    }
    return TakeFromHand(base, std::move(working), std::get<HandPoints>(choice));
  }();
  if (!found) return found;
  done("faces and their points found");
  FrontPhoto& front = *found;
  front.scale = scale;
  front.whole_size = {front.photo.width, front.photo.height};
  FoundFace* face = front.face ? &front.face->found : nullptr;
  if (face) front.face->nose = face->PixelOf(point::kNoseTip);
  if (face && extent == PhotoExtent::kCloseUp) {
    if (front.orientation != 1) photo = Turned(photo, front.orientation);
    CloseUp close_up = CloseUpOf(front.photo, photo, *face);
    front.photo = std::move(close_up.image);
    *face = std::move(close_up.face);
    front.scale *= close_up.scale;
  }
  front.figure =
      face ? FindFigureOf(networks, front.photo, *face) : FindFigure(networks, front.photo);
  if (face) front.face->occlusion = DetectOcclusion(networks, base, *face, front.photo);
  done("figure cut out");
  return found;
}

vm::Result<MadeFace> MakeFace(const ObservedHead& base, const FrontPhoto& front,
                              const FrontFace& front_face, std::optional<SidePhotoSet> from_side,
                              std::optional<bool> glasses, const StepDone& done) {
  const std::size_t count = from_side ? from_side->photos.size() : 0;
  if (auto few = CheckSidePhotoCount(count); !few) return std::unexpected(few.error());
  const FoundFace& face = front_face.found;
  if (auto shown = CheckFeaturesShown(face, front.photo); !shown) {
    return std::unexpected(shown.error());
  }
  SidePhotoFit fitted{FitFace(base, face, front.photo), {}, {}};
  done("head fitted");
  if (from_side) {
    fitted =
        UseSidePhotos(from_side->networks, front.photo, from_side->photos, std::move(fitted.fit));
  }
  auto& [fit, views, rejected] = fitted;
  if (rejected.size() < count) done("seen from the side, too");
  BakedHead baked = BakeHead(face, fit, front.photo, front.figure, views);
  baked.head.glasses = glasses ? *glasses : WearsGlasses(face, front.photo);
  done("photo put on");
  std::string report = Report(front, front_face, fit, baked);
  return MadeFace{std::move(fit), std::move(baked), std::move(report), std::move(rejected)};
}

}  // namespace facefit
