#include "face_fit/make_face.h"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/find/face/close_up.h"
#include "face_fit/find/face/cut_off.h"
#include "face_fit/find/face/glasses.h"
#include "face_fit/find/face/upright.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/stereo.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/photo.h"
#include "face_fit/report.h"

namespace facefit {
namespace {

/// A photo in its full and in its working size, and the chosen face.
struct PhotoWithFace {
  fsm::Image finest, working;
  int orientation = 1;
  int faces = 1;
  std::optional<FoundFace> face = {};
};

/// Finds the chosen face; one overload for each kind of choice.
struct FaceSearch {
  FaceNetworks& networks;
  const ObservedHead& base;
  fsm::Image finest, working;

  vm::Result<PhotoWithFace> operator()(const FaceNumber& choice) {
    UprightPhoto upright = SetUpright(networks, std::move(working));
    if (upright.orientation != 1) finest = Turned(finest, upright.orientation);
    PhotoWithFace found{std::move(finest), std::move(upright.photo), upright.orientation,
                        static_cast<int>(upright.faces.size())};
    if (upright.faces.empty()) return found;
    auto face = ChooseFace(upright.faces, choice.number);
    if (!face) return std::unexpected(face.error());
    found.face = std::move(*face);
    return found;
  }
  vm::Result<PhotoWithFace> operator()(const FaceNear& choice) {
    const float scale = static_cast<float>(working.width) / static_cast<float>(finest.width);
    const auto faces = FindFaces(networks, working);
    PhotoWithFace found{std::move(finest), std::move(working), 1, static_cast<int>(faces.size())};
    const auto nearest = std::ranges::min_element(faces, {}, [&](const FoundFace& face) {
      return glm::distance(face.PixelOf(point::kNoseTip), scale * choice.nose);
    });
    if (nearest != faces.end()) found.face = *nearest;
    return found;
  }
  vm::Result<PhotoWithFace> operator()(const HandPoints& choice) {
    if (auto within = CheckWithin(choice, working.width, working.height); !within) {
      return std::unexpected(within.error());
    }
    return PhotoWithFace{.finest = std::move(finest),
                         .working = std::move(working),
                         .face = FaceFromHand(base, choice)};
  }
};

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
  const int given_longer = std::max(photo.width, photo.height);
  fsm::Image working = extent == PhotoExtent::kWhole ? photo : ScaledToFit(photo, kWorkingSize);
  auto found = std::visit(FaceSearch{networks, base, std::move(photo), std::move(working)}, choice);
  if (!found) return std::unexpected(found.error());
  done("faces and their points found");
  const glm::ivec2 whole_size(found->working.width, found->working.height);
  const glm::vec2 nose = found->face ? found->face->PixelOf(point::kNoseTip) : glm::vec2(0);
  float scale =
      static_cast<float>(std::max(whole_size.x, whole_size.y)) / static_cast<float>(given_longer);
  if (found->face && extent == PhotoExtent::kCloseUp) {
    CloseUp close_up = CloseUpOf(found->working, found->finest, *found->face);
    found->working = std::move(close_up.photo);
    found->face = std::move(close_up.face);
    scale *= close_up.scale;
  }
  const FoundFace* face = found->face ? &*found->face : nullptr;
  FigureCutout figure = CutOutFigure(found->working, SegmentPerson(networks, found->working, face));
  Occlusion occlusion;
  if (face) occlusion = DetectOcclusion(networks, base, *face, found->working);
  done("figure cut out");
  return FrontPhoto{.photo = std::move(found->working),
                    .face = std::move(found->face),
                    .figure = std::move(figure),
                    .occlusion = std::move(occlusion),
                    .faces = found->faces,
                    .orientation = found->orientation,
                    .scale = scale,
                    .nose = nose,
                    .whole_size = whole_size};
}

vm::Result<MadeFace> MakeFace(const ObservedHead& base, const FrontPhoto& front,
                              const SidePhotos& side_photos, std::optional<bool> glasses,
                              const StepDone& done) {
  if (auto few = CheckSidePhotoCount(side_photos.photos.size()); !few) {
    return std::unexpected(few.error());
  }
  assert(front.face);
  const FoundFace& face = *front.face;
  if (auto shown = CheckFeaturesShown(face, front.photo); !shown) {
    return std::unexpected(shown.error());
  }
  Fit fit = FitFace(base, face, &front.photo);
  done("head fitted");
  std::vector<SideView> views;
  std::vector<MadeFace::LeftOut> left_out;
  for (const SidePhoto* side_photo : side_photos.photos) {
    auto view = CorrectDepthBy(*side_photos.networks, front.photo, *side_photo, fit);
    if (!view) {
      left_out.push_back({side_photo->path, view.error().text});
    } else if (*view) {
      views.push_back(std::move(**view));
    }
  }
  // Later photos changed the depth that the poses of earlier ones were found on.
  for (SideView& view : views) {
    RefineSidePose(fit.head, front.photo, view.photo->photo, view.pose);
  }
  if (left_out.size() < side_photos.photos.size()) done("seen from the side, too");
  TextureBake bake = BakeTexture(face, fit, front.photo, front.figure, views);
  bake.head.glasses = glasses ? *glasses : WearsGlasses(face, front.photo);
  done("photo put on");
  std::string report = Report(face, fit, front.photo, bake, front.faces, front.occlusion);
  return MadeFace{std::move(fit), std::move(bake), std::move(report), std::move(left_out)};
}

}  // namespace facefit
