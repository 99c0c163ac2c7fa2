#include "face_editor/core/photo_work.h"

#include <exception>
#include <filesystem>
#include <glm/geometric.hpp>

#include "face_editor/core/table_writer.h"
#include "face_fit/find/face/hand_points.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/photo.h"
#include "face_fit/side/use_side_photos.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/head/make_head.h"
#include "fsm/image/image_file.h"

namespace editor {
namespace {

facefit::FoundFace FoundFrom(const PointMap& points) {
  facefit::FoundFace face;
  face.certainty = 1;
  for (const auto& [i, at] : points) face.points[static_cast<std::size_t>(i)] = at;
  face.crop = facefit::CropAround(face.points);
  return face;
}

PointMap PointsOf(const facefit::FoundFace& face) {
  PointMap points;
  for (std::size_t i = 0; i < face.points.size(); ++i) {
    points[static_cast<int>(i)] = face.points[i];
  }
  return points;
}

}  // namespace

vm::Result<std::shared_ptr<FaceModels>> LoadFaceModels(const std::string& folder,
                                                       const std::string& tables) {
  auto networks = facefit::FaceNetworks::Load(folder);
  if (!networks) return std::unexpected(networks.error());
  auto models = std::make_shared<FaceModels>(FaceModels{std::move(*networks), nullptr, {}});
  try {
    auto base = facefit::ObservedHead::BuiltIn(models->networks, "galatea");
    if (!base) return std::unexpected(base.error());
    if (const auto units = fsm::UnitsIn(tables)) base->UseUnits(*units);
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < facefit::kNetworkPoints; ++i) points.push_back(base->AtRest(i));
    models->mirror = MirrorOf(points);
    models->base = std::make_shared<const facefit::ObservedHead>(std::move(*base));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kUnavailable, error.what());
  }
  return models;
}

PointMap AllPoints(const PhotoWork& work, const PointMap& known) {
  facefit::HandPoints hand;
  for (const auto& [i, at] : known) hand[static_cast<std::size_t>(i)] = glm::vec2(at);
  return PointsOf(facefit::FaceFromHand(*work.base, hand));
}

vm::Result<std::shared_ptr<const PhotoWork>> OpenPhoto(FaceModels* models, const std::string& path,
                                                       int face) {
  auto photo = facefit::ReadPhoto(path);
  if (!photo) return std::unexpected(photo.error());
  auto work = std::make_shared<PhotoWork>();
  work->path = path;
  work->found = PlainPoints(photo->width, photo->height);
  if (!models) {
    work->front.photo.image = std::move(*photo);
    work->mirror = MirrorByName();
    work->notice =
        "The networks that find faces are not installed (scripts/face_networks.sh): "
        "points can be set and saved, but no face be made of them";
    return work;
  }
  try {
    auto front = facefit::PrepareFront(models->networks, *models->base, std::move(*photo),
                                       facefit::FaceNumber{face}, facefit::PhotoExtent::kWhole);
    if (!front) return std::unexpected(front.error());
    work->front = std::move(*front);
    work->base = models->base;
    work->mirror = models->mirror;
    if (work->front.face) {
      work->found = PointsOf(work->front.face->found);
      if (work->front.photo.orientation != 1)
        work->notice = "The photo was lying; it was set upright";
    } else {
      work->notice = "No face was found: drag the points to where eyes, nose, mouth and chin are";
      work->found = AllPoints(*work, work->found);
    }
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, path + ": " + error.what());
  }
  return work;
}

vm::Result<std::shared_ptr<const facefit::SidePhoto>> OpenSidePhoto(FaceModels& models,
                                                                    const PhotoWork& work,
                                                                    const PointMap& points,
                                                                    const std::string& path) {
  try {
    auto side_photo = facefit::ReadSidePhoto(models.networks, path);
    if (!side_photo) return std::unexpected(side_photo.error());
    const facefit::SidePhoto* const only[] = {&*side_photo};
    const auto used = facefit::UseSidePhotos(
        models.networks, work.front.photo.image, only,
        facefit::FitFace(*work.base, FoundFrom(points), work.front.photo.image));
    if (!used.rejected.empty()) {
      return vm::Fail(vm::Errc::kBadValue, path + ": " + used.rejected.front().reason);
    }
    return std::make_shared<const facefit::SidePhoto>(std::move(*side_photo));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, path + ": " + error.what());
  }
}

vm::Result<std::shared_ptr<const BuiltFace>> BuildFace(const PhotoWork& work,
                                                       const PointMap& points, FaceModels* models,
                                                       const SidePhotos& sides) {
  try {
    std::vector<const facefit::SidePhoto*> side_photos;
    for (const auto& side : sides) side_photos.push_back(side.get());
    facefit::FrontFace face = work.front.face.value_or(facefit::FrontFace{});
    face.found = FoundFrom(points);
    face.nose_whole_px = face.found.PixelOf(facefit::point::kNoseTip);
    const auto from_side =
        models ? std::optional(facefit::SidePhotoSet{models->networks, side_photos}) : std::nullopt;
    auto made = facefit::MakeFace(*work.base, work.front.photo, face, from_side);
    if (!made) return std::unexpected(made.error());
    auto built = std::make_shared<BuiltFace>();
    built->base = work.base;
    built->made = std::move(*made);
    built->head = fsm::MakeHead(built->made.baked.head);
    return built;
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue,
                    std::string("these points do not make a face: ") + error.what());
  }
}

}  // namespace editor
