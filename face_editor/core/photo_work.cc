#include "face_editor/core/photo_work.h"

#include <exception>
#include <filesystem>
#include <glm/geometric.hpp>

#include "face_editor/core/table_writer.h"
#include "face_fit/find/face/hand_points.h"
#include "face_fit/find/face/upright.h"
#include "face_fit/find/figure/figure_finder.h"
#include "face_fit/fit/side_fit.h"
#include "face_fit/fit/side_view.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/photo.h"
#include "face_fit/report.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/head/face_folder.h"
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
    auto base = facefit::BaseHead::See(sight->networks, "galatea");
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
  work->photo = std::move(*photo);
  const auto by_hand = [&] {
    work->found = PlainPoints(work->photo.width, work->photo.height);
    if (work->base) work->found = AllPoints(*work, work->found);
  };
  if (!sight) {
    work->mirror = MirrorByName();
    work->notice =
        "The networks that find faces are not installed (scripts/face_networks.sh): "
        "points can be set and saved, but no face be made of them";
    by_hand();
    return work;
  }
  try {
    if (const int orientation = facefit::UprightOrientation(sight->networks, work->photo);
        orientation != 1) {
      work->photo = facefit::Turned(work->photo, orientation);
      work->notice = "The photo was lying; it was set upright";
    }
    work->base = sight->base;
    work->mirror = sight->mirror;
    const auto faces = facefit::FindFaces(sight->networks, work->photo);
    work->faces = static_cast<int>(faces.size());
    if (face < 1 || (face > work->faces && face != 1)) {
      return vm::Fail(vm::Errc::kBadValue, "face " + std::to_string(face) + ": there are " +
                                               std::to_string(work->faces) +
                                               ", counted from the largest");
    }
    if (faces.empty()) {
      work->notice = "No face was found: drag the points to where eyes, nose, mouth and chin are";
      by_hand();
    } else {
      const facefit::FoundFace& found = faces[static_cast<std::size_t>(face - 1)];
      work->found = PointsOf(found);
      work->cover = facefit::DetectOcclusion(sight->networks, *work->base, found, work->photo);
    }
    const facefit::FoundFace seen = FoundFrom(work->found);
    work->figure = facefit::CutOut(
        work->photo,
        facefit::FindPerson(sight->networks, work->photo, faces.empty() ? nullptr : &seen));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, path + ": " + error.what());
  }
  return work;
}

vm::Result<std::shared_ptr<const SidePhoto>> OpenSidePhoto(FaceSight& sight, const PhotoWork& work,
                                                           const PointMap& points,
                                                           const std::string& path) {
  try {
    auto photo = facefit::ReadUpright(sight.networks, path);
    if (!photo) return std::unexpected(photo.error());
    const auto fit = facefit::FitFace(*work.base, FoundFrom(points), &work.photo);
    if (auto placed = facefit::FitSideView(sight.networks, *work.base, fit.head, *photo); !placed) {
      return vm::Fail(placed.error().code, path + ": " + placed.error().text);
    }
    return std::make_shared<const SidePhoto>(SidePhoto{path, std::move(*photo)});
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, path + ": " + error.what());
  }
}

vm::Result<std::shared_ptr<const BuiltFace>> BuildFace(const PhotoWork& work,
                                                       const PointMap& points, FaceSight* sight,
                                                       const SidePhotos& sides) {
  try {
    auto built = std::make_shared<BuiltFace>();
    const facefit::FoundFace face = FoundFrom(points);
    built->fit = facefit::FitFace(*work.base, face, &work.photo);
    std::vector<facefit::SideView> seen;
    for (const auto& side : sides) {
      auto view =
          facefit::LookFromSide(sight->networks, *work.base, work.photo, side->photo, built->fit);
      if (view) {
        seen.push_back(std::move(*view));
      } else {
        built->left_out +=
            (built->left_out.empty() ? "" : "; ") + side->path + ": " + view.error().text;
      }
    }
    facefit::TextureBake bake =
        facefit::BakeTexture(*work.base, face, built->fit, work.photo, *work.figure, seen);
    built->report = facefit::Report(face, built->fit, work.photo, bake, work.faces, work.cover);
    built->photo_head = std::move(bake.head);
    built->head = fsm::MakeHead(built->photo_head);
    return built;
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue,
                    std::string("these points do not make a face: ") + error.what());
  }
}

}  // namespace editor
