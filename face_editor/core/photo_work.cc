#include "face_editor/core/photo_work.h"

#include <exception>
#include <filesystem>
#include <glm/geometric.hpp>

#include "face_editor/core/table_writer.h"
#include "face_fit/find/face/hand_points.h"
#include "face_fit/find/face/upright.h"
#include "face_fit/picture/photo.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/head/make_head.h"
#include "fsm/image/image_file.h"

namespace editor {
namespace {

facefit::FoundFace FoundFrom(const PointMap& points) {
  facefit::FoundFace face;
  face.certainty = 1;
  for (const auto& [i, at] : points) face.points.push_back(at);
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

vm::Result<std::shared_ptr<FaceSight>> LoadSight(const std::string& folder,
                                                 const std::string& tables) {
  auto networks = facefit::FaceNetworks::Load(folder);
  if (!networks) return std::unexpected(networks.error());
  auto sight = std::make_shared<FaceSight>(FaceSight{std::move(*networks), nullptr, {}});
  try {
    auto base = facefit::BaseHead::Observe(sight->networks, "galatea");
    if (!base) return std::unexpected(base.error());
    if (const auto units = fsm::UnitsIn(tables)) base->MoveBy(*units);
    std::vector<glm::vec3> places;
    for (const auto& place : base->points) places.push_back(place.On(base->rest.position));
    sight->mirror = MirrorOf(places);
    sight->base = std::make_shared<const facefit::BaseHead>(std::move(*base));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kUnavailable, error.what());
  }
  return sight;
}

PointMap AllPoints(const PhotoWork& work, const PointMap& known) {
  facefit::HandPoints hand;
  for (const auto& [i, at] : known) hand[static_cast<std::size_t>(i)] = glm::vec2(at);
  return PointsOf(facefit::FaceFromHand(*work.base, hand));
}

vm::Result<std::shared_ptr<const PhotoWork>> OpenPhoto(FaceSight* sight, const std::string& path,
                                                       int face) {
  auto photo = facefit::ReadPhoto(path);
  if (!photo) return std::unexpected(photo.error());
  auto work = std::make_shared<PhotoWork>();
  work->path = path;
  work->found = PlainPoints(photo->width, photo->height);
  if (!sight) {
    work->front.photo = std::move(*photo);
    work->mirror = MirrorByName();
    work->notice =
        "The networks that find faces are not installed (scripts/face_networks.sh): "
        "points can be set and saved, but no face be made of them";
    return work;
  }
  try {
    const facefit::UprightFaces seen = facefit::FindUprightFaces(sight->networks, *photo);
    if (seen.orientation != 1) work->notice = "The photo was lying; it was set upright";
    work->base = sight->base;
    work->mirror = sight->mirror;
    std::optional<facefit::FoundFace> found;
    if (seen.faces.empty() && face == 1) {
      work->notice = "No face was found: drag the points to where eyes, nose, mouth and chin are";
      work->found = AllPoints(*work, PlainPoints(photo->width, photo->height));
    } else {
      auto chosen = facefit::ChooseFace(seen.faces, face);
      if (!chosen) return std::unexpected(chosen.error());
      found = std::move(*chosen);
      work->found = PointsOf(*found);
    }
    work->front =
        facefit::LookAtFront(sight->networks, *work->base, std::move(*photo),
                             found ? &*found : nullptr, static_cast<int>(seen.faces.size()));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, path + ": " + error.what());
  }
  return work;
}

vm::Result<std::shared_ptr<const facefit::ExtraPhoto>> OpenExtraPhoto(FaceSight& sight,
                                                                      const PhotoWork& work,
                                                                      const PointMap& points,
                                                                      const std::string& path) {
  try {
    auto extra = facefit::ReadExtraPhoto(sight.networks, path);
    if (!extra) return extra;
    const auto fit = facefit::FitFace(*work.base, FoundFrom(points), &work.front.photo);
    if (auto placed = facefit::FitExtraView(sight.networks, fit.head, **extra); !placed) {
      return vm::Fail(placed.error().code, path + ": " + placed.error().text);
    }
    return extra;
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, path + ": " + error.what());
  }
}

vm::Result<std::shared_ptr<const BuiltFace>> BuildFace(const PhotoWork& work,
                                                       const PointMap& points, FaceSight* sight,
                                                       const ExtraPhotos& extras) {
  try {
    auto built = std::make_shared<BuiltFace>();
    built->base = work.base;
    built->made = facefit::MakeFace(*work.base, work.front, FoundFrom(points),
                                    sight ? &sight->networks : nullptr, extras);
    built->head = fsm::MakeHead(built->made.bake.head);
    return built;
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue,
                    std::string("these points do not make a face: ") + error.what());
  }
}

}  // namespace editor
