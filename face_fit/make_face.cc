#include "face_fit/make_face.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/find/face/close_up.h"
#include "face_fit/find/face/cut_off.h"
#include "face_fit/find/face/glasses.h"
#include "face_fit/find/face/upright.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/photo.h"
#include "face_fit/report.h"

namespace facefit {
namespace {

/// A photo, set upright, and the face that was chosen in it.
struct FaceSearch {
  fsm::Image photo;
  std::optional<FoundFace> face;
  int face_count = 0;
  int orientation = 1;  ///< EXIF orientation of the photo as given
};

/// Searches a photo for a face as a FaceChoice says.
struct FaceSearcher {
  FaceNetworks& networks;
  const ObservedHead& base;
  fsm::Image photo;
  float photo_per_given_pixel;

  vm::Result<FaceSearch> operator()(const FaceNumber& choice) {
    UprightPhoto upright = SetUpright(networks, std::move(photo));
    const int count = static_cast<int>(upright.faces.size());
    FaceSearch search{std::move(upright.image), {}, count, upright.orientation};
    if (count == 0) return search;
    if (choice.number < 1 || choice.number > count) {
      return vm::Fail(
          vm::Errc::kBadValue,
          fmt::format("face {}: there are {}, counted from the largest", choice.number, count));
    }
    search.face = std::move(upright.faces[static_cast<std::size_t>(choice.number - 1)]);
    return search;
  }
  vm::Result<FaceSearch> operator()(const FaceNear& choice) {
    const glm::vec2 nose = photo_per_given_pixel * choice.nose;
    const auto faces = FindFaces(networks, photo);
    FaceSearch search{std::move(photo), {}, static_cast<int>(faces.size())};
    const auto nearest = std::ranges::min_element(faces, {}, [nose](const FoundFace& face) {
      return glm::distance(face.PixelOf(point::kNoseTip), nose);
    });
    if (nearest != faces.end()) search.face = *nearest;
    return search;
  }
  vm::Result<FaceSearch> operator()(const HandPoints& points) {
    if (auto within = CheckWithin(points, photo.width, photo.height); !within) {
      return std::unexpected(within.error());
    }
    return FaceSearch{std::move(photo), FaceFromHand(base, points), 1};
  }
};

/// Reduces a search to the surroundings of its face, with the pixels of the photo as given. Returns
/// close-up pixels for each whole pixel. REQUIRES: search.face.
float CropToFace(fsm::Image given, FaceSearch& search) {
  assert(search.face);
  if (search.orientation != 1) given = OrientedByExif(given, search.orientation);
  CloseUp close_up = CloseUpOf(search.photo, given, *search.face);
  search.photo = std::move(close_up.image);
  search.face = std::move(close_up.face);
  return close_up.scale;
}

float LongerSide(const fsm::Image& photo) {
  return static_cast<float>(std::max(photo.width, photo.height));
}

}  // namespace

vm::Result<PreparedFront> PrepareFront(FaceNetworks& networks, const ObservedHead& base,
                                       fsm::Image photo, const FaceChoice& choice,
                                       PhotoExtent extent, const StepDone& done) {
  fsm::Image whole = extent == PhotoExtent::kWhole ? photo : ScaledToFit(photo, kWorkingSize);
  float scale = LongerSide(whole) / LongerSide(photo);
  auto search = std::visit(FaceSearcher{networks, base, std::move(whole), scale}, choice);
  if (!search) return std::unexpected(search.error());
  done("faces and their points found");
  const glm::ivec2 whole_size_px(search->photo.width, search->photo.height);
  std::optional<FrontFace> face;
  if (search->face) {
    const glm::vec2 nose_whole_px = search->face->PixelOf(point::kNoseTip);
    if (extent == PhotoExtent::kCloseUp) scale *= CropToFace(std::move(photo), *search);
    face = FrontFace{*search->face, DetectOcclusion(networks, base, *search->face, search->photo),
                     nose_whole_px};
  }
  FigureCutout figure = face ? FindFigureOf(networks, search->photo, face->found)
                             : FindFigure(networks, search->photo);
  done("figure cut out");
  return PreparedFront{.photo = {.image = std::move(search->photo),
                                 .figure = std::move(figure),
                                 .face_count = search->face_count,
                                 .orientation = search->orientation,
                                 .closeup_per_given_pixel = scale,
                                 .whole_size_px = whole_size_px},
                       .face = std::move(face)};
}

vm::Result<MadeFace> MakeFace(const ObservedHead& base, const FrontPhoto& front,
                              const FrontFace& front_face, std::optional<SidePhotoSet> from_side,
                              std::optional<bool> glasses, const StepDone& done) {
  const std::size_t count = from_side ? from_side->photos.size() : 0;
  assert(count <= kMaxSidePhotos);
  const FoundFace& face = front_face.found;
  if (auto shown = CheckFeaturesShown(face, front.image); !shown) {
    return std::unexpected(shown.error());
  }
  SidePhotoFit fitted{FitFace(base, face, front.image), {}, {}};
  done("head fitted");
  if (from_side) {
    fitted =
        UseSidePhotos(from_side->networks, front.image, from_side->photos, std::move(fitted.fit));
  }
  auto& [fit, views, rejected] = fitted;
  if (rejected.size() < count) done("seen from the side, too");
  const CompletedFigure whole = CompleteFigure(fit.head, front.figure);
  BakedHead baked = BakeHead(face, fit, front.image, front.figure, whole, views,
                             glasses ? *glasses : WearsGlasses(face, front.image));
  done("photo put on");
  std::string report = Report(front, front_face, fit, whole.completed, baked);
  return MadeFace{std::move(fit), std::move(baked), std::move(report), std::move(rejected)};
}

}  // namespace facefit
